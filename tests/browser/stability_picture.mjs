// The README's stability map, from what `stability_map` wrote:
//   node --test stability_picture.mjs with WEFT_STABILITY_MAP=map.csv and WEFT_SCREENSHOTS=folder
import {readFile, writeFile} from 'node:fs/promises';
import {join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {openPage} from './harness.mjs';

test('the map', async () => {
  const page = await readFile(fileURLToPath(new URL('../stability/map.html', import.meta.url)), 'utf8');
  const csv = await readFile(process.env.WEFT_STABILITY_MAP, 'utf8');
  const filled = join(process.env.WEFT_SCREENSHOTS, 'stability-map.html');
  await writeFile(filled, page.replace('/*map*/null', () => JSON.stringify(csv)));
  const opened = await openPage(pathToFileURL(filled).href, {viewport: {width: 960, height: 720}});
  await opened.page.waitForSelector('#map polygon');
  await opened.page.screenshot({path: join(process.env.WEFT_SCREENSHOTS, 'stability-map.png'), fullPage: true});
});
