// Colours of charts and scenes: the custom properties of page.css, which differ between light and dark.
'use strict';

swiftlet.theme = (() => {
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
  const series = (index) => colour('series-' + (index % 8));
  const onChange = (callback) => dark.addEventListener('change', callback);
  return {colour, series, onChange};
})();
