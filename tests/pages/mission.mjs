// Looks at the page of a mission in a browser. usage: mission.mjs PAGE PICTURES. Prints what it found as JSON.
import {checkLook, launch, withPage} from './browser.mjs';

const [file, pictures] = process.argv.slice(2);
const found = {};
const browser = await launch();
try {
  await withPage(browser, file, {width: 1280}, async (page) => {
    Object.assign(found, await page.evaluate(() => {
      const speed = swiftlet.charts.find((chart) => chart.spec.title === 'Speed');
      return {
        charts: swiftlet.charts.map((chart) => chart.spec.title),
        speed: speed.spec.series.map((series) => series.label),
        fence: JSON.parse(document.getElementById('flights').textContent)[0].fence,
      };
    }));
  });
  await checkLook(browser, file, `${pictures}/mission`);
} finally {
  await browser.close();
}
console.log(JSON.stringify(found));
