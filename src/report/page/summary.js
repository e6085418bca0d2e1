// summary.js: the numbers of the fits: the table of all of them, and what one says of itself.

const element = id => document.getElementById(id);

// `tag` with text and attributes; `children` are elements.
function make(tag, text = '', attributes = {}, children = []) {
  const made = document.createElement(tag);
  made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

// Up to `digits` significant digits; "-" for null.
function numberText(value, digits = 3) {
  if (value === null || value === undefined) return '–';
  if (typeof value !== 'number') return String(value);
  if (value === 0 || Number.isInteger(value) && Math.abs(value) < 1e6) return String(value);
  const size = Math.abs(value);
  return size < 1e-4 || size >= 1e6 ? String(Number(value.toPrecision(digits)).toExponential())
                                    : String(Number(value.toPrecision(digits)));
}

const measureOf = (material, key) => material.measures.find(measure => measure.key === key).value;

// Of the table: a name, how to get the value, and how many digits it is shown with.
const columns = [
  ['material', material => material.name, 0],
  ['log error', material => measureOf(material, 'mean_abs_log_error'), 3],
  ['floor', material => measureOf(material, 'reciprocal_floor'), 3],
  ['relative error', material => measureOf(material, 'relative_error'), 3],
  ['ΔE 2000', material => measureOf(material, 'delta_e_mean'), 3],
  ['PSNR, dB', material => material.pictures.psnr, 3],
  ['FLIP', material => material.pictures.flip, 3],
  ['largest albedo', material => measureOf(material, 'max_directional_albedo'), 5],
  ['energy', material => measureOf(material, 'energy'), 0],
];

function compare(a, b) {
  if (a === null || b === null) return (a === null) - (b === null);
  return typeof a === 'number' ? a - b : String(a).localeCompare(String(b));
}

// The table of all fits; onSelect(index) when one is chosen.
class SummaryTable {
  constructor(materials, onSelect) {
    this.sorting = {column: 0, descending: false};
    this.table = element('fits');
    this.rows = materials.map((material, index) => this.row(material, index, onSelect));
    const headers = columns.map(([title], column) => {
      const button = make('button', title, {type: 'button'});
      button.addEventListener('click', () => this.sortBy(column));
      return make('th', '', {scope: 'col'}, [button]);
    });
    this.table.tHead.append(make('tr', '', {}, headers));
    element('filter').addEventListener('input', () => this.update());
    this.update();
  }

  row(material, index, onSelect) {
    const values = columns.map(([, valueOf]) => valueOf(material));
    const button = make('button', material.name, {type: 'button'});
    button.addEventListener('click', () => onSelect(index));
    const cells = values.slice(1).map((value, k) => make('td', numberText(value, columns[k + 1][2] || 3)));
    return {index, values, cells: make('tr', '', {}, [make('td', '', {}, [button]), ...cells])};
  }

  sortBy(column) {
    const again = this.sorting.column === column;
    this.sorting = {column, descending: again && !this.sorting.descending};
    this.update();
  }

  select(index) {
    for (const row of this.rows) {
      if (row.index === index) row.cells.setAttribute('aria-current', 'true');
      else row.cells.removeAttribute('aria-current');
    }
  }

  update() {
    const {column, descending} = this.sorting;
    const part = element('filter').value.trim().toLowerCase();
    const shown = this.rows.filter(row => row.values[0].toLowerCase().includes(part));
    shown.sort((a, b) => (descending ? -1 : 1) * compare(a.values[column], b.values[column]));
    this.table.tBodies[0].replaceChildren(...shown.map(row => row.cells));
    element('shown').textContent = `${shown.length} of ${this.rows.length}`;
    [...this.table.tHead.rows[0].cells].forEach((cell, k) => {
      if (k === column) cell.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
      else cell.removeAttribute('aria-sort');
    });
  }
}

function showVerdicts(material) {
  const error = measureOf(material, 'mean_abs_log_error'), floor = measureOf(material, 'reciprocal_floor');
  const certified = measureOf(material, 'energy') === 'certified';
  const verdicts = [
    [numberText(error), 'mean log error', ''],
    [numberText(floor), 'the data\'s own floor', ''],
    [material.pictures.psnr === null ? 'equal' : `${numberText(material.pictures.psnr)} dB`, 'PSNR of the picture', ''],
    [certified ? 'certified' : 'not certified', 'energy', certified ? 'good' : 'bad'],
    [numberText(measureOf(material, 'parameters')), 'numbers in the fit', ''],
  ];
  element('verdicts').replaceChildren(...verdicts.map(([value, name, kind]) =>
      make('li', '', {class: kind}, [make('b', value), make('small', name)])));
}

// What physics demands, and whether it holds.
function showCertificate(material) {
  const value = key => measureOf(material, key);
  const hue = numberText(value('dark_hue_chroma_p95'));
  const lines = [
    [value('energy') === 'certified',
     `Energy: the largest directional albedo is ${numberText(value('max_directional_albedo'), 6)}` +
     (value('energy') === 'certified' ? '.' : `: ${value('energy')}.`)],
    [value('hrl') === 0 && value('hcl') === 0,
     `Reciprocity: HRL ${numberText(value('hrl'))}, HCL ${numberText(value('hcl'))}.`],
    [true, 'Values are never negative: what would be is cut at 0.'],
    [null, `Colour: where it is dark, 95 % of the colours are within ${hue} of the material's (CIELAB a, b).`],
  ];
  const kinds = new Map([[true, 'good'], [false, 'bad'], [null, 'open']]);
  element('certificate').replaceChildren(
      ...lines.map(([holds, text]) => make('li', text, {class: kinds.get(holds)})));
}

function showMeasures(material) {
  showVerdicts(material);
  showCertificate(material);
  element('measures').tBodies[0].replaceChildren(...material.measures.map(({key, value, meaning}) =>
      make('tr', '', {}, [make('td', key), make('td', numberText(value, 5)), make('td', meaning)])));
  element('cautions').replaceChildren(...material.cautions.map(caution => make('li', caution)));
  element('description').textContent = `${material.fit_file}: ${material.description}`;
  element('command').textContent = material.command || 'The fit\'s file doesn\'t say how it was made.';
}
