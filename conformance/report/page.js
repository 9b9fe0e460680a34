'use strict';
// Shows the rows and findings of the chosen subject, category and verdict whose case holds the text searched for.
const form = document.querySelector('form');
const shown = document.querySelector('output');
const filtered = [...document.querySelectorAll('[data-subject]')];
const sections = document.querySelectorAll('section');
const tables = [...document.querySelectorAll('.rows')].map((table) => [table, [...table.querySelectorAll('tbody tr')]]);
const kLine = 34;  // pixels of a usual row: a guess for tables not laid out yet, on which only the scroll bar depends

function filter() {
  const {subject, category, verdict, search} = form.elements;
  const wanted = search.value.toLowerCase();
  for (const element of filtered) {
    const {subject: s, category: c, verdict: v, name} = element.dataset;
    element.hidden = (subject.value !== '' && subject.value !== s) || (category.value !== '' && category.value !== c) ||
        (verdict.value !== '' && verdict.value !== v) || !name.toLowerCase().includes(wanted);
  }
  for (const section of sections) section.hidden = !section.querySelector('article:not([hidden])');
  let count = 0, all = 0;
  for (const [table, rows] of tables) {
    const left = rows.filter((row) => !row.hidden).length;
    table.hidden = left === 0;
    table.style.containIntrinsicHeight = `${(left + 1) * kLine}px`;
    count += left;
    all += rows.length;
  }
  shown.textContent = count === all ? `all ${all} results` : `${count} of ${all} results`;
}

form.addEventListener('input', filter);
form.addEventListener('submit', (event) => event.preventDefault());
// What comes into view on the way may prove taller than it was taken for: go there once more when it is laid out.
function go_to(target) {
  target.scrollIntoView();
  requestAnimationFrame(() => requestAnimationFrame(() => target.scrollIntoView()));
}

document.querySelector('#summary').addEventListener('click', (event) => {
  const cell = event.target.closest('a[data-choose]');
  if (!cell) return;
  [form.elements.subject.value, form.elements.category.value, form.elements.verdict.value] =
      cell.dataset.choose.split(' ');
  form.elements.search.value = '';
  filter();
  go_to(document.querySelector('#results'));
});

// A link to a finding has to lead there even if the filter hides it; a known deviation opens.
function reveal() {
  const target = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
  if (!target) return;
  if (target.closest('[hidden]')) {
    form.reset();
    filter();
  }
  const details = target.matches('article') && target.querySelector('details');
  if (details) details.open = true;
  go_to(target);
}
window.addEventListener('hashchange', reveal);
form.hidden = false;
filter();
reveal();
