// Looks at pages of figures in a browser. usage: figures.mjs PICTURES PAGE... Prints the captions of each page as JSON.
import {basename} from 'node:path';
import {checkLook, launch, require, withPage} from './browser.mjs';

const [pictures, ...files] = process.argv.slice(2);
const found = {};

// Of each figure: its caption, its text, and whether its series are in the picture: without them it differs.
const drawn = (page) => page.evaluate(() => swiftlet.figures.map((figure) => {
  const picture = () => {
    figure.graph.updateOptions({});
    return figure.plot.querySelector('canvas').toDataURL();
  };
  const series = figure.series;
  const full = picture();
  figure.series = [];
  const empty = picture();
  figure.series = series;
  return {caption: figure.panel.caption, text: figure.plot.getAttribute('aria-label'), hasSeries: picture() === full && full !== empty};
}));

const browser = await launch();
try {
  for (const file of files) {
    await withPage(browser, file, {width: 1280}, async (page) => {
      const figures = await drawn(page);
      for (const {caption, text, hasSeries} of figures) {
        require(hasSeries, `${file}: ${caption}: draws nothing`);
        require(text.includes(' to '), `${file}: ${caption}: its text is '${text}'`);
      }
      found[basename(file)] = figures.map(({caption}) => caption);
    });
    await checkLook(browser, file, `${pictures}/${basename(file, '.html')}`);
  }
} finally {
  await browser.close();
}
console.log(JSON.stringify(found));
