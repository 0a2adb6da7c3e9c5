// The browsers that the tests drive: Debian's Chromium, and with WEFT_BROWSER=firefox Debian's Firefox as it is, by WebDriver BiDi.
// Both draw WebGL on the processor.
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {readFileSync} from 'node:fs';

export const kFirefox = process.env.WEFT_BROWSER === 'firefox';

const kChromium = {
  executablePath: process.env.WEFT_CHROMIUM ?? '/usr/bin/chromium',
  args: [
    '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
    '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
    // Only the canvas is drawn by WebGL: in software that is a slow way to draw the rest of the page.
    '--disable-gpu-rasterization', '--disable-gpu-compositing',
  ],
};

/** `display` is an X server's: without one Firefox finds no WebGL driver, headless or not. */
export const firefox = (display) => ({
  channel: 'moz-firefox',
  executablePath: process.env.WEFT_FIREFOX ?? '/usr/bin/firefox-esr',
  headless: false,
  env: {...process.env, DISPLAY: display, LIBGL_ALWAYS_SOFTWARE: '1', MOZ_X11_EGL: '1'},
  firefoxUserPrefs: {
    'webgl.force-enabled': true,
    // Only the canvas is drawn by WebGL, as above.
    'gfx.webrender.software': true,
    // Windows of other tests lie above a page: it is not to be slowed down for that.
    'widget.windows.window_occlusion_tracking.enabled': false,
    'dom.min_background_timeout_value': 4,
  },
});

/** Loaded where it is needed: that takes a second. */
const driver = async () => import('playwright-core').then((all) => (kFirefox ? all.firefox : all.chromium));

/** An X server that draws into memory, at a display number of its own choice. */
export async function startScreen() {
  const screen = spawn('Xvfb', ['-displayfd', '3', '-screen', '0', '1280x1024x24', '-nolisten', 'tcp'],
    {stdio: ['ignore', 'ignore', 'ignore', 'pipe']});
  const failed = once(screen, 'exit').then(([code]) => {
    throw new Error(`Xvfb ended with ${code}`);
  });
  failed.catch(() => {});
  const [number] = await Promise.race([once(screen.stdio[3], 'data'), failed]);
  return {display: `:${String(number).trim()}`, close: () => screen.kill('SIGTERM')};
}

/** Starts the browser by `begin(driver, options)` and, where it needs one, a screen that is gone when the browser is. */
async function launch(begin) {
  if (!kFirefox) return begin(await driver(), kChromium);
  const screen = await startScreen();
  try {
    const browser = await begin(await driver(), firefox(screen.display));
    const close = browser.close.bind(browser);
    browser.close = () => close().finally(screen.close);
    return browser;
  } catch (error) {
    screen.close();
    throw error;
  }
}

/** One that others may connect to. */
export const launchServer = () => launch((type, options) => type.launchServer({...options, handleSIGTERM: false}));

/** The run's browser if there is one, else one of the caller's own: `close()` ends what the caller began, no more. */
export async function openBrowser() {
  const file = process.env.WEFT_SHARED_BROWSER;
  if (file) return (await driver()).connect(JSON.parse(readFileSync(file)).address);
  return launch((type, options) => type.launch(options));
}
