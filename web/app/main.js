/** Shows what the address asks for, the gallery, a scene or one at several levels, and goes from one to the other without loading the page again. */
import {Gallery} from '../gallery/gallery.js';
import {addressOfScene, readSettings} from './settings.js';
import {Hud} from './hud.js';
import {publishEmptyHook} from './hook.js';
import {ScenePage} from './scene_page.js';
import {SplitPage} from '../split/split_page.js';

const hud = new Hud();
const screens = {gallery: document.getElementById('gallery'), scene: document.getElementById('scene-page'), split: document.getElementById('split-page')};

try {
  start(readSettings(new URL(location.href), devicePixelRatio));
} catch (error) {
  hud.showFailure(error);
}

function start(settings) {
  publishEmptyHook();
  document.documentElement.classList.toggle('low', !settings.high);
  const access = {token: settings.token};  // a token that a viewer has typed goes for all that this page opens
  let shown = null;
  /** Each is made when it is first shown. */
  const make = {
    gallery: () => new Gallery(screens.gallery, settings, access, hud, {
      open: goTo,
      single: (name) => {
        history.replaceState(null, '', addressOfScene(new URL(location.href), name));
        follow();
      },
    }),
    scene: () => new ScenePage(settings, access, hud, {goTo}),
    split: () => new SplitPage(screens.split, settings, access, hud, {goTo}),
  };
  const made = {};

  function show(which) {
    const before = shown;
    if (before !== which && before !== null) made[before].leave();
    shown = which;
    for (const [name, screen] of Object.entries(screens)) screen.hidden = name !== which;
    made[which] ??= make[which]();
    // What had the focus is gone: the keyboard goes on where the viewer does.
    if (before !== null && before !== which) made[which].focus();
    return made[which];
  }

  /** Shows what the address says now. */
  function follow() {
    const {scene, split} = readSettings(new URL(location.href), devicePixelRatio);
    try {
      if (split !== null) show('split').enter(split);
      else if (scene === null) show('gallery').enter();
      else show('scene').enter(scene);
    } catch (error) {
      shown = null;  // it was never made
      hud.showFailure(error);
    }
  }

  /** Follows a link of the page's own. @param {string} address */
  function goTo(address) {
    history.pushState(null, '', address);
    follow();
  }

  addEventListener('popstate', follow);
  follow();
}
