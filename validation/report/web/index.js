// The list of all cases: sorts and filters the table.
'use strict';
(() => {
  const table = document.getElementById('cases');
  if (!table) return;
  const body = table.tBodies[0], rows = [...body.rows];
  const headings = [...table.tHead.rows[0].cells];
  const compare = new Intl.Collator(undefined, {numeric: true, sensitivity: 'base'}).compare;

  // ---- sorting: unknown values last, equal ones in the order that they had

  function sort(column, direction) {
    const sign = direction === 'ascending' ? 1 : -1;
    const keyed = [...body.rows].map((row) => ({row, key: row.cells[column].dataset.key}));
    const numeric = keyed.every(({key}) => key === '' || !isNaN(key));
    keyed.sort((a, b) => {
      if (a.key === '' || b.key === '') return (a.key === '') - (b.key === '');
      return sign * (numeric ? a.key - b.key : compare(a.key, b.key));
    });
    body.append(...keyed.map(({row}) => row));
    for (const heading of headings) heading.removeAttribute('aria-sort');
    headings[column].setAttribute('aria-sort', direction);
  }
  headings.forEach((heading, column) => {
    if (!heading.dataset.first) return;
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = heading.textContent;
    heading.replaceChildren(button);
    button.addEventListener('click', () => {
      const other = {ascending: 'descending', descending: 'ascending'};
      sort(column, other[heading.getAttribute('aria-sort')] || heading.dataset.first);
    });
  });

  // ---- filtering: every word must occur

  const find = document.getElementById('find'), boxes = [...document.getElementsByName('verdict')];
  const texts = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));
  function filter() {
    const words = find.value.toLowerCase().split(/\s+/).filter(Boolean);
    const verdicts = new Set(boxes.filter((box) => box.checked).map((box) => box.value));
    let count = 0;
    for (const row of rows) {
      const text = texts.get(row);
      row.hidden = !verdicts.has(row.dataset.verdict) || !words.every((w) => text.includes(w));
      count += row.hidden ? 0 : 1;
    }
    document.getElementById('count').textContent = `${count} of ${rows.length} shown`;
    document.getElementById('none').hidden = count > 0;
  }
  find.addEventListener('input', filter);
  for (const box of boxes) box.addEventListener('change', filter);
  document.getElementById('filters').hidden = false;
  filter();
})();
