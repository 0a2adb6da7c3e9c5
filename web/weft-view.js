/** For other pages: `<script type="module" src="https://weft.example/weft-view.js">` defines the element `weft-view`. */
import {WeftView} from './embed/weft_view.js';

customElements.define('weft-view', WeftView);
