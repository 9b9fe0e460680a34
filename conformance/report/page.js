'use strict';
// Shows the rows and findings of the chosen subject, category and verdict whose case holds the text searched for.
const form = document.querySelector('form');
const shown = document.querySelector('output');
const filtered = [...document.querySelectorAll('[data-subject]')];
const rows = filtered.filter((element) => element.matches('tr'));

function filter() {
  const {subject, category, verdict, search} = form.elements;
  const wanted = search.value.toLowerCase();
  for (const element of filtered) {
    const {subject: s, category: c, verdict: v, name} = element.dataset;
    element.hidden = (subject.value !== '' && subject.value !== s) || (category.value !== '' && category.value !== c) ||
        (verdict.value !== '' && verdict.value !== v) || !name.toLowerCase().includes(wanted);
  }
  const count = rows.filter((row) => !row.hidden).length;
  shown.textContent = count === rows.length ? `all ${count} results` : `${count} of ${rows.length} results`;
}

form.addEventListener('input', filter);
form.addEventListener('submit', (event) => event.preventDefault());
document.querySelector('#summary').addEventListener('click', (event) => {
  const cell = event.target.closest('a[data-choose]');
  if (!cell) return;
  [form.elements.subject.value, form.elements.category.value, form.elements.verdict.value] =
      cell.dataset.choose.split(' ');
  form.elements.search.value = '';
  filter();
});
// A link to a finding has to lead there even if the filter hides it; a known deviation opens.
function reveal() {
  const target = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
  if (!target || !target.matches('article')) return;
  if (target.hidden) {
    form.reset();
    filter();
  }
  const details = target.querySelector('details');
  if (details) details.open = true;
  target.scrollIntoView();
}
window.addEventListener('hashchange', reveal);
form.hidden = false;
filter();
reveal();
