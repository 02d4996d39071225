// A picture of the live page once the first vehicle has flown two metres. usage: node picture.mjs URL OUT.png
import {launch, withPage} from './browser.mjs';

const [url, picture] = process.argv.slice(2);
const browser = await launch();
try {
  await withPage(browser, url, {width: 1280}, async (page) => {
    await page.waitForFunction(() => {
      const {north, east} = swiftlet.livePage.vehicles[0]?.path ?? {north: [], east: []};
      let flown = 0;
      for (let i = 1; i < north.length; ++i) flown += Math.hypot(north[i] - north[i - 1], east[i] - east[i - 1]);
      return flown > 2;
    }, {timeout: 60000, polling: 100});
    await page.screenshot({path: picture});
  });
} finally {
  await browser.close();
}
