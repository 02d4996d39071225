// Uses the page of flights in a browser. usage: flight.mjs PAGE OTHER_PAGE PICTURES. PAGE is of one flight, OTHER_PAGE of two.
// Prints what it found as JSON.
import {checkLook, launch, require, settled, withPage} from './browser.mjs';

const [one, two, pictures] = process.argv.slice(2);
const found = {};
const same = ([a, b], [c, d]) => Math.abs(a - c) < 1e-6 && Math.abs(b - d) < 1e-6;
const ranges = (page) => page.evaluate(() =>
  swiftlet.charts.filter((chart) => chart.graph && chart.visible).map((chart) => chart.graph.xAxisRange()));

async function dragInFirstChart(page) {
  const plot = await page.$('.plot');
  await plot.evaluate((element) => element.scrollIntoView({block: 'center'}));
  await settled(page);
  const {x, y, width} = await plot.boundingBox();
  await page.mouse.move(x + 0.4 * width, y + 80);
  await page.mouse.down();
  await page.mouse.move(x + 0.5 * width, y + 80, {steps: 4});
  await page.mouse.up();
}

async function checkZoom(page) {
  const whole = await page.evaluate(() => [...swiftlet.axis.range]);
  await dragInFirstChart(page);
  await page.waitForFunction(() => swiftlet.axis.range[0] > swiftlet.axis.start);
  await settled(page);
  const shown = await ranges(page);
  require(shown.length >= 2, 'less than two charts are on the screen');
  require(shown.every((range) => same(range, shown[0])), `the ranges differ: ${shown}`);
  const [from, to] = shown[0];
  require(to - from < 0.2 * (whole[1] - whole[0]), `the drag zoomed only to ${from} .. ${to}`);
  // Zoomed in, each sample is a point.
  const points = await page.evaluate(async () => {
    const chart = swiftlet.charts[0];
    const [from, to] = swiftlet.axis.range;
    const inside = (times) => times.filter((time) => time >= from && time <= to);
    const drawn = inside(Array.from({length: chart.graph.numRows()}, (_, i) => chart.graph.getValue(i, 0)));
    return [drawn.length, new Set(chart.lines.flatMap((line) => inside(Array.from(line.t)))).size];
  });
  require(points[0] === points[1] && points[0] > 50, `${points[0]} points drawn of ${points[1]} samples`);
  await page.evaluate(() => window.scrollTo(0, document.body.scrollHeight / 2));
  await settled(page);
  require((await ranges(page)).every((range) => same(range, shown[0])), 'a chart that comes to the screen is not zoomed');
  await page.click('#whole');
  await settled(page);
  require((await ranges(page)).every((range) => same(range, whole)), 'the whole flight is not shown again');
}

async function checkSlider(page) {
  await page.evaluate(() => window.scrollTo(0, 0));
  const before = await (await page.$('#scene')).screenshot({encoding: 'base64'});
  await page.focus('#time');
  const start = await page.evaluate(() => swiftlet.axis.cursor);
  for (let i = 0; i < 10; ++i) await page.keyboard.press('PageUp');
  await page.waitForFunction((time) => swiftlet.axis.cursor > time + 3, {}, start);
  const [cursor, text, left] = await page.evaluate(() =>
    [swiftlet.axis.cursor, document.getElementById('time-text').textContent,
     parseFloat(document.querySelector('.plot .hairline')?.style.left ?? 'NaN')]);
  require(text === `${cursor.toFixed(2)} s`, `the text is ${text} at ${cursor} s`);
  require(left > 60, `the hairline is at ${left} px`);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const after = await (await page.$('#scene')).screenshot({encoding: 'base64'});
  require(before !== after, 'the vehicle did not move with the slider');
}

async function checkTexts(page) {
  const plain = await page.evaluate(() => [...document.querySelectorAll('.plot, #scene canvas')]
    .map((element) => element.getAttribute('aria-label')).filter((label) => !label));
  require(plain.length === 0, `${plain.length} pictures have no text`);
  const chart = await page.$('.chart details');
  await chart.evaluate((details) => details.querySelector('summary').click());
  await page.waitForSelector('.chart details table');
  found.table = await chart.$$eval('tr', (rows) => rows.map((row) => [...row.children].map((cell) => cell.textContent)));
  const named = await page.$$eval('button', (buttons) =>
    buttons.filter((button) => !(button.textContent.trim() || button.getAttribute('aria-label'))).length);
  require(named === 0, `${named} buttons have no name`);
  found.events = await page.$$eval('#events tr', (rows) => rows.map((row) => row.textContent));
  found.summary = Object.fromEntries(await page.$$eval('.top tr', (rows) =>
    rows.map((row) => [...row.children].map((cell) => cell.textContent))));
}

const browser = await launch();
try {
  await withPage(browser, one, {width: 1280}, async (page, ms) => {
    found.ready_ms = Math.round(ms);
    await checkZoom(page);
    await checkSlider(page);
    await checkTexts(page);
    found.charts = await page.evaluate(() => swiftlet.charts.map((chart) => chart.spec.title));
  });
  await withPage(browser, two, {width: 1280}, async (page) => {
    found.overlaid = await page.evaluate(() => swiftlet.charts[0].spec.series.map((series) => series.label));
    found.vehicles = await page.$$eval('#timeline .timeline', (rows) => rows.length);
  });
  await checkLook(browser, one, `${pictures}/flight`);
} finally {
  await browser.close();
}
console.log(JSON.stringify(found));
