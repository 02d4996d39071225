// How long a page takes in a browser until it is ready. usage: load_time.mjs PAGE TIMES. Prints the milliseconds as JSON.
import {launch, withPage} from './browser.mjs';

const [page, times] = process.argv.slice(2);
const browser = await launch();
const ready_ms = [];
for (let i = 0; i < Number(times); ++i) await withPage(browser, page, {width: 1280}, (_, ms) => ready_ms.push(Math.round(ms)));
await browser.close();
console.log(JSON.stringify(ready_ms));
