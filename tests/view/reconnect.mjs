// Uses the live page in a browser while its server ends and another one of one vehicle fewer takes its place.
// usage: node reconnect.mjs URL GONE STAYS, two names of vehicles. Prints 'shown' and waits for a line: the server has
// ended. Prints 'silent' once both vehicles are shown so, and waits for a line: there is a server again. Prints 'back' once
// the vehicle STAYS is shown again beside the silent one.
import readline from 'node:readline';

import {launch, require} from './browser.mjs';

const [url, gone, stays] = process.argv.slice(2);
const lines = readline.createInterface({input: process.stdin})[Symbol.asyncIterator]();
const badge = (page, name, isSilent) => page.waitForFunction((vehicle, wanted) => {
  const text = document.querySelector(`[data-vehicle="${vehicle}"] .badge`)?.textContent ?? 'not heard';
  return text !== 'not heard' && text.startsWith('silent') === wanted;
}, {timeout: 20000}, name, isSilent);

const browser = await launch();
try {
  const page = await browser.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.stack));
  await page.goto(url);
  for (const name of [gone, stays]) await badge(page, name, false);
  console.log('shown');
  await lines.next();
  for (const name of [gone, stays]) await badge(page, name, true);
  console.log('silent');
  await lines.next();
  await badge(page, stays, false);
  await badge(page, gone, true);
  const events = await page.$$eval('#events p', (rows) => rows.map((row) => row.dataset.at + row.textContent));
  require(new Set(events).size === events.length, `events stand twice: ${events}`);
  require(faults.length === 0, faults.join('\n'));
  console.log('back');
} finally {
  await browser.close();
}
process.exit();
