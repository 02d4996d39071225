// A headless Chromium whose pages must load nothing beside themselves and log no error.
import puppeteer from 'puppeteer-core';

export function require(holds, what) {
  if (!holds) throw new Error(what);
}

export const launch = () => puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

// Calls look(page, ms) with the page when it is ready, and how long that took.
export async function withPage(browser, file, {width, scheme = 'light'}, look) {
  const page = await browser.newPage();
  const faults = [];
  page.on('console', (message) => {
    if (['error', 'warn'].includes(message.type())) faults.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => faults.push(`error: ${error.stack}`));
  page.on('request', (request) => {
    if (request.url() !== 'file://' + file && !request.url().startsWith('data:')) faults.push(`loads ${request.url()}`);
  });
  await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value: scheme}]);
  await page.setViewport({width, height: 900});
  const started = performance.now();
  await page.goto('file://' + file);
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'true', {timeout: 30000});
  await look(page, performance.now() - started);
  require(faults.length === 0, `${file}: ${faults.join('\n')}`);
  await page.close();
}

// Waits until every chart on the screen shows the range of the axis.
export const settled = (page) => page.waitForFunction(() => swiftlet.charts.every((chart) => !chart.visible || !chart.stale));
