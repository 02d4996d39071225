// Elements and texts that all parts of a page use.
'use strict';

swiftlet.element = (name, attributes = {}, text = '') => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text) element.textContent = text;
  return element;
};

swiftlet.table = (head, rows) => {
  const table = swiftlet.element('table');
  const add = (cells, kind) => {
    const row = swiftlet.element('tr');
    const label = (i) => (kind === 'td' && i > 0 ? {'data-label': head[i]} : {});
    cells.forEach((cell, i) => row.append(swiftlet.element(kind, label(i), cell)));
    table.append(row);
  };
  add(head, 'th');
  rows.forEach((row) => add(row, 'td'));
  const box = swiftlet.element('div', {class: head.length > 2 ? 'wide stacks' : 'wide'});
  box.append(table);
  return box;
};

// Up to five significant digits.
swiftlet.number = (value) => {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e6)) return value.toExponential(2).replace('-', '−');
  return String(Number(value.toPrecision(5))).replace('-', '−');
};

// The least and the largest of some numbers.
swiftlet.extent = (values) => {
  let [least, most] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < least) least = value;
    if (value > most) most = value;
  }
  return [least, most];
};
