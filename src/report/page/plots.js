// plots.js: slices, albedos and the fit's course, drawn by Chart.js.

const luminanceWeights = [0.2126, 0.7152, 0.0722];
const channelNames = ['red', 'green', 'blue'];
let charts = [];

const colour = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// One list from those of the three channels; channel 3 is luminance.
function channelOf(values, channel) {
  if (channel < 3) return values[channel];
  return values[0].map((red, n) => red === null ? null :
      luminanceWeights[0] * red + luminanceWeights[1] * values[1][n] + luminanceWeights[2] * values[2][n]);
}

const cosine = degrees => Math.cos(degrees * Math.PI / 180);
const pointsOf = (xs, ys) => xs.map((x, n) => ({x, y: ys[n]}));

// A logarithmic axis has no place for these.
const positive = points => points.map(({x, y}) => ({x, y: y > 0 ? y : null}));

const fitLine = {borderWidth: 2, pointRadius: 0, spanGaps: false};
const materialLine = {borderWidth: 1.5, borderDash: [5, 4], pointRadius: 0, spanGaps: false};
const dots = {showLine: false, pointRadius: 2.5, pointBorderWidth: 1};

// Fit, material and measurements along each curve; transform(x, y) is what is plotted of a value.
function curveDatasets(curves, channel, symbol, transform, finish) {
  return curves.flatMap((curve, k) => {
    const lineColour = colour(`curve${k}`), label = `${symbol} ${numberText(curve.angle, 3)}°`;
    const points = (xs, ys) => finish(pointsOf(xs, ys.map((y, n) => y === null ? null : transform(xs[n], y))));
    const dataset = (name, style, xs, values) => ({
      label: name, ...style, borderColor: lineColour, backgroundColor: lineColour, data: points(xs, values)});
    return [
      dataset(label, fitLine, curve.x, channelOf(curve.fit, channel)),
      dataset(`${label}, material`, materialLine, curve.x, channelOf(curve.material, channel)),
      dataset(`${label}, measured`, dots, curve.measured_x, channelOf(curve.measured, channel)),
    ].filter(({data}) => data.length > 0);
  });
}

function axis(title, extra = {}) {
  return {title: {display: true, text: title, color: colour('quiet')}, ticks: {color: colour('quiet')},
          grid: {color: colour('line')}, ...extra};
}

// A logarithmic axis with a tick for each power of ten.
function logAxis(title, extra = {}) {
  const isPower = value => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-6;
  return axis(title, {type: 'logarithmic', ...extra, ticks: {
    color: colour('quiet'), callback: value => isPower(value) ? numberText(value) : null}});
}

function draw(id, datasets, scales, legend = text => !/material|measured/.test(text), extra = {}) {
  const labels = {color: colour('text'), boxWidth: 14, boxHeight: 2, filter: item => legend(item.text)};
  charts.push(new Chart(element(id), {
    type: 'line',
    data: {datasets},
    options: {
      animation: false, maintainAspectRatio: false, parsing: false, normalized: true,
      interaction: {mode: 'nearest', intersect: false},
      scales, ...extra,
      plugins: {legend: {labels}, tooltip: {callbacks: {
        label: ({dataset, parsed}) => `${dataset.label}: ${numberText(parsed.y)} at ${numberText(parsed.x)}`,
        title: () => ''}}},
    },
  }));
}

function drawPlane(curves, channel, logarithmic) {
  const finish = logarithmic ? positive : points => points;
  const datasets = curveDatasets(curves, channel, 'θi', (x, f) => f * cosine(x), finish);
  const y = logarithmic ? logAxis('f cos θo, 1/sr') : axis('f cos θo, 1/sr', {beginAtZero: true});
  draw('plot-plane', datasets, {x: axis('θo, degrees', {type: 'linear', min: -90, max: 90}), y});
}

function drawPolar(curves, channel) {
  const largest = curves.map(curve => Math.max(
      ...channelOf(curve.material, channel).map((f, n) => f === null ? 0 : f * cosine(curve.x[n])), 1e-12));
  const place = (x, r) => ({x: r * Math.sin(x * Math.PI / 180), y: r * cosine(x)});
  const line = (curve, k, key, style, label) => ({
    label, ...style, borderColor: colour(`curve${k}`), backgroundColor: colour(`curve${k}`),
    data: channelOf(curve[key], channel).map((f, n) =>
        f === null ? {x: NaN, y: NaN} : place(curve.x[n], f * cosine(curve.x[n]) / largest[k]))});
  const datasets = curves.flatMap((curve, k) => {
    const label = `θi ${numberText(curve.angle, 3)}°`;
    return [line(curve, k, 'fit', fitLine, label),
            line(curve, k, 'material', materialLine, `${label}, material`)];
  });
  for (const r of [0.25, 0.5, 0.75, 1]) {
    const angles = Array.from({length: 61}, (_, n) => 3 * n - 90);
    datasets.push({label: `material ${r}`, borderColor: colour('line'), borderWidth: 1, pointRadius: 0,
                   data: angles.map(angle => place(angle, r))});
  }
  const bare = {ticks: {display: false}, grid: {display: false}};
  draw('plot-polar', datasets, {x: {type: 'linear', min: -1.1, max: 1.1, ...bare}, y: {min: 0, max: 1.1, ...bare}},
       undefined, {interaction: {mode: 'point'}, maintainAspectRatio: true, aspectRatio: 1.85});
}

function drawHalf(curves, channel) {
  const onAxis = points => positive(points).map(({x, y}) => ({x: Math.max(x, 0.03), y}));
  const datasets = curveDatasets(curves, channel, 'θd', (x, f) => f, onAxis);
  draw('plot-half', datasets, {x: logAxis('θh, degrees', {min: 0.03, max: 90}), y: logAxis('f, 1/sr')});
}

function drawAlbedo(albedo) {
  const datasets = channelNames.flatMap((name, c) => {
    const style = {borderColor: colour(name), backgroundColor: colour(name)};
    return [{label: name, ...fitLine, ...style, data: pointsOf(albedo.theta_i, albedo.fit[c])},
            {label: `${name}, material`, ...materialLine, ...style, data: pointsOf(albedo.theta_i, albedo.material[c])}];
  });
  datasets.push({label: '1', ...materialLine, borderColor: colour('bad'), backgroundColor: colour('bad'),
                 data: [{x: 0, y: 1}, {x: 90, y: 1}]});
  draw('plot-albedo', datasets, {x: axis('θi, degrees', {type: 'linear', min: 0, max: 90}),
                                 y: axis('albedo', {min: 0, suggestedMax: 1.05})});
}

function drawHistory(history, floor) {
  const points = history.map(([, seconds, error]) => ({x: seconds, y: error}));
  const datasets = [{label: 'error', ...fitLine, borderColor: colour('curve0'), backgroundColor: colour('curve0'),
                     data: positive(points)}];
  if (floor > 0) {
    datasets.push({label: 'floor of the data', ...materialLine, borderColor: colour('quiet'),
                   backgroundColor: colour('quiet'), data: [{x: 0, y: floor}, {x: points.at(-1).x, y: floor}]});
  }
  draw('plot-history', datasets, {x: axis('seconds', {type: 'linear', min: 0}), y: logAxis('error')}, () => true);
}

// All plots of a material, anew.
function drawPlots(material) {
  for (const chart of charts) chart.destroy();
  charts = [];
  const channel = Number(document.querySelector('input[name=channel]:checked').value);
  const {in_plane: plane, half_angle: half, albedo} = material.curves;
  drawPlane(plane, channel, element('plane-log').checked);
  drawPolar(plane, channel);
  drawHalf(half, channel);
  drawAlbedo(albedo);
  const known = material.history !== null && material.history.length > 0;
  element('history').hidden = !known;
  element('no-history').textContent = known ? '' :
      'How the error fell with time isn\'t known: pbnbrdf fit --summary=NAME.json records it.';
  if (known) drawHistory(material.history, measureOf(material, 'reciprocal_floor'));
}
