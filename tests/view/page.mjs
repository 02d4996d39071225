// Uses the live page in a browser while two vehicles fly. usage: node page.mjs URL PICTURES. Prints a JSON object.
import {launch, require, withPage} from './browser.mjs';

const [url, pictures] = process.argv.slice(2);
const found = {};
const card = (name) => `[data-vehicle="${name}"]`;
const mode = (page, name, text) => page.waitForFunction((selector, wanted) =>
  document.querySelector(`${selector} .badge`)?.textContent === wanted, {timeout: 20000}, card(name), text);
const answer = async (page, name, begin) => {
  await page.waitForFunction((selector, wanted) => {
    const text = document.querySelector(`${selector} .answer`)?.textContent ?? '';
    return text.startsWith(wanted) && !text.endsWith(': sent');
  }, {timeout: 10000}, card(name), begin);
  return page.$eval(`${card(name)} .answer`, (element) => element.textContent);
};
const confirm = async (page, choice) => {
  await page.waitForSelector('#confirm[open]');
  await page.click(`#confirm [value="${choice}"]`);
  await page.waitForFunction(() => !document.querySelector('#confirm[open]'));
};
const press = async (page, name, kind, choice = 'yes') => {
  await page.click(`${card(name)} [data-request="${kind}"]`);
  await confirm(page, choice);
};
// Until the page has so many points of each vehicle.
const flown = (page, points) => page.waitForFunction((count) =>
  swiftlet.livePage.vehicles.length === 2 && swiftlet.livePage.vehicles.every(({track}) => track.length > count), {timeout: 15000}, points);

async function checkLook(browser) {
  const papers = new Set();
  for (const scheme of ['light', 'dark']) {
    for (const width of [1280, 390]) {
      await withPage(browser, url, {width, scheme}, async (page) => {
        await flown(page, 60);
        const height = await page.evaluate(() => document.documentElement.scrollHeight);
        await page.setViewport({width, height});
        await page.waitForFunction(() => swiftlet.charts.every((chart) => chart.graph && chart.graph.xAxisRange()[1] > 1));
        await page.screenshot({path: `${pictures}/view-${scheme}-${width}.png`});
        // Charts take the width of the screen a frame after it has changed.
        await page.waitForFunction((most) => document.documentElement.scrollWidth <= most, {timeout: 5000}, width).catch(async () => {
          const wide = await page.$$eval('body *', (elements, most) => elements
            .filter((element) => element.getBoundingClientRect().right > most)
            .map((element) => `${element.tagName} ${element.className} ${element.id}`), width);
          throw new Error(`wider than the screen of ${width} px: ${wide}`);
        });
        papers.add(await page.evaluate(() => getComputedStyle(document.body).backgroundColor));
      });
    }
  }
  require(papers.size === 2, 'light and dark look the same');
}

async function addSignal(page) {
  const chosen = await page.$$eval('#topic, #signal', (lists) => lists.map((list) => list.value));
  require(chosen[0] === 'estimate' && !/stamp|sequence/.test(chosen[1]), `the signal at first: ${chosen}`);
  await page.select('#topic', 'imu');
  await page.select('#signal', 'specific_force_frd[2]');
  await page.click('#add-signal button');
  await page.waitForFunction(() => {
    const {chart} = swiftlet.livePage.charts.at(-1);
    return chart.graph && chart.lines.length === 2 && chart.lines.every(({y}) => y.length > 20 && Math.abs(y.at(-1)) > 1);
  }, {timeout: 10000});
}

async function checkNames(page) {
  const unnamed = await page.$$eval('button, select', (elements) => elements.filter((element) =>
    !(element.textContent.trim() || element.getAttribute('aria-label'))).length);
  require(unnamed === 0, `${unnamed} controls have no name`);
}

const browser = await launch();
try {
  await withPage(browser, url, {width: 1280}, async (page) => {
    await flown(page, 10);
    const [t0, n0] = await page.evaluate(() => [swiftlet.livePage.vehicles[0].track.times().at(-1), swiftlet.livePage.vehicles[0].track.length]);
    await flown(page, 120);
    const [t1, n1] = await page.evaluate(() => [swiftlet.livePage.vehicles[0].track.times().at(-1), swiftlet.livePage.vehicles[0].track.length]);
    found.rate_hz = Math.round((n1 - n0) / (t1 - t0));
    await addSignal(page);
    await checkNames(page);
    const warning = await page.$eval('#slow', (element) => element.textContent);
    require(!warning || warning.startsWith('this viewer is slow'), `the page shows: ${warning}`);
    found.charts = await page.$$eval('.chart', (charts) => charts.length);
    found.vehicles = await page.$$eval('.vehicle', (cards) => cards.length);
  });
  await checkLook(browser);
  // Opened again.
  await withPage(browser, url, {width: 1280}, async (page) => {
    await flown(page, 5);
    await press(page, 'kl1', 'hold');
    require(await answer(page, 'kl1', 'hold: ') === 'hold: accepted', 'hold was not accepted');
    await mode(page, 'kl1', 'holding');
    found.holding = true;
    await page.waitForFunction(() => Math.hypot(...swiftlet.livePage.vehicles[0].newest.estimate.velocity_ned) < 0.02);
    found.held_at_m = await page.evaluate(() => swiftlet.livePage.vehicles[0].newest.estimate.position_ned[0]);
    // A stop that is not confirmed sends nothing: the vehicle flies on.
    await press(page, 'kl1', 'stop', 'no');
    require(await answer(page, 'kl1', 'hold: accepted'), 'stop was sent');
    await page.click('#stop-all');
    await page.waitForSelector('#confirm[open]');
    const title = await page.$eval('#confirm', (dialog) => document.getElementById(dialog.getAttribute('aria-labelledby')).textContent);
    require(title === 'Stop the rotors of kl1, kl2?', `the dialog is named '${title}'`);
    await confirm(page, 'no');
    const apart = await page.$$eval('[data-vehicle="kl1"] .buttons button', ([, land, stop]) =>
      stop.getBoundingClientRect().left - land.getBoundingClientRect().right);
    require(apart > 20, `Stop is ${apart} px beside Land`);
    await page.click('#land-all');
    await confirm(page, 'yes');
    for (const name of ['kl1', 'kl2']) require(await answer(page, name, 'land: ') === 'land: accepted', `${name}: land was not accepted`);
    for (const name of ['kl1', 'kl2']) await mode(page, name, 'disarmed');
    found.landed = true;
    const answers = await page.$eval('#answers', (element) => element.textContent);
    require(answers === 'land accepted by kl1, kl2', `the answers: ${answers}`);
    await press(page, 'kl2', 'hold');
    found.refusal = (await answer(page, 'kl2', 'hold: refused: ')).replace('hold: ', '');
    const events = await page.$$eval('#events p', (rows) => rows.map((row) => row.textContent));
    require(events.some((event) => event.includes('kl1: landing')), `events: ${events}`);
  });
} finally {
  await browser.close();
}
console.log(JSON.stringify(found));
