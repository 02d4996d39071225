// A headless Chromium whose pages must load nothing beside themselves and log no error.
import puppeteer from 'puppeteer-core';

export function require(holds, what) {
  if (!holds) throw new Error(what);
}

export const launch = () => puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

// file: a path, or the URL of a server. Calls look(page, ms) with the page when it is ready, and how long that took.
export async function withPage(browser, file, {width, scheme = 'light'}, look) {
  const page = await browser.newPage();
  const address = file.includes('://') ? file : 'file://' + file;
  const faults = [];
  page.on('console', (message) => {
    if (['error', 'warn'].includes(message.type())) faults.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => faults.push(`error: ${error.stack}`));
  page.on('request', (request) => {
    if (request.url() !== address && !request.url().startsWith('data:')) faults.push(`loads ${request.url()}`);
  });
  await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value: scheme}]);
  await page.setViewport({width, height: 900});
  const started = performance.now();
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'true', {timeout: 30000});
  await look(page, performance.now() - started);
  require(faults.length === 0, `${file}: ${faults.join('\n')}`);
  await page.close();
}

// Waits until every chart on the screen shows the range of the axis.
export const settled = (page) => page.waitForFunction(() => swiftlet.charts.every((chart) => !chart.visible || !chart.stale));

// Light and dark, on a wide screen and on a telephone. Writes pictures whose names begin with `pictures`.
export async function checkLook(browser, file, pictures) {
  const papers = new Set();
  for (const scheme of ['light', 'dark']) {
    for (const width of [1280, 390]) {
      await withPage(browser, file, {width, scheme}, async (page) => {
        await settled(page);
        await page.screenshot({path: `${pictures}-${scheme}-${width}.png`});
        const [wide, paper] = await page.evaluate(() =>
          [document.documentElement.scrollWidth, getComputedStyle(document.body).backgroundColor]);
        require(wide <= width, `${file}: ${wide} px wide on a screen of ${width} px`);
        const cut = await page.$$eval('.wide', (boxes) => boxes.filter((box) => box.scrollWidth > box.clientWidth)
          .map((box) => box.querySelector('tr').textContent));
        require(width > 390 || cut.length === 0, `${file}: columns are cut off on a screen of ${width} px: ${cut}`);
        papers.add(paper);
      });
    }
  }
  require(papers.size === 2, `${file}: light and dark look the same`);
}
