// The README's work-precision diagram, from a page that `weft cost --out` wrote:
//   node --test cost_picture.mjs with WEFT_COST=page.html and WEFT_SCREENSHOTS=folder
import {join} from 'node:path';
import {test} from 'node:test';
import {pathToFileURL} from 'node:url';
import {openPage} from './harness.mjs';

test('the diagram', async () => {
  const {page} = await openPage(pathToFileURL(process.env.WEFT_COST).href, {viewport: {width: 1240, height: 900}, deviceScaleFactor: 960 / 1240});
  await page.waitForSelector('.panel .point');
  await page.screenshot({path: join(process.env.WEFT_SCREENSHOTS, 'work-precision.jpg'), fullPage: true, quality: 85});
});
