// main.js: reads the page's data and shows one material at a time.

const data = JSON.parse(element('report-data').textContent);
let current = data.materials[0];
let sphere = null;

function showPictures({pictures, name}) {
  const pictureOf = {material: pictures.material, fit: pictures.fit, flip: pictures.flip_map};
  for (const [id, url] of Object.entries(pictureOf)) {
    const picture = element(`picture-${id}`);
    picture.src = url;
    picture.width = pictures.width;
    picture.height = pictures.height;
  }
  // A few pixels aren't shown as large as many.
  element('pictures').style.maxWidth = `${Math.max(5 * pictures.width, 640)}px`;
  element('picture-material').alt = `${name}, rendered`;
  element('picture-fit').alt = `The fit to ${name}, rendered`;
  element('flip-scale').style.background =
      `linear-gradient(to right, ${pictures.flip_scale.map(rgb => `rgb(${rgb})`).join(', ')})`;
  element('picture-errors').textContent =
      `Mean FLIP ${numberText(pictures.flip)}, SSIM ${numberText(pictures.ssim, 4)}, ` +
      (pictures.psnr === null ? 'no difference.' : `PSNR ${numberText(pictures.psnr)} dB.`);
}

function withoutSphere(reason) {
  element('interactive').hidden = true;
  element('no-sphere').hidden = false;
  element('no-sphere').textContent = `There is no sphere to turn: ${reason}.`;
}

function showSphere(material) {
  const {glsl, table} = material.sphere;
  element('left-tag').textContent = table ? 'material' : '';
  element('right-tag').textContent = glsl ? 'fit' : '';
  element('sphere-notes').textContent = [
    glsl ? 'The fit is evaluated for each pixel.' : 'The fit is no network: it has no shader.',
    table ? `The material is shown from a table of ${table.size.join(' × ')} values over θh, θd and φd, averaged over ` +
            'both orders of directions.' : 'The material is anisotropic: it has no small table.'].join(' ');
  if (!sphere) return;
  try {
    sphere.show(material);
  } catch (error) {
    sphere = null;
    withoutSphere(error.message);
  }
}

function select(index) {
  current = data.materials[index];
  document.title = `${current.name}: fitted BRDF`;
  element('name').textContent = current.name;
  element('source').textContent = current.source;
  showMeasures(current);
  showPictures(current);
  showSphere(current);
  drawPlots(current);
}

function start() {
  element('version').textContent = data.version;
  const count = data.materials.length;
  element('about').textContent = count === 1 ? 'A material and the neural BRDF that was fitted to it' :
      `${count} materials and the neural BRDFs that were fitted to them`;
  try {
    sphere = new SphereView(element('sphere'), data.lights);
  } catch (error) {
    withoutSphere(error.message);
  }
  if (data.lights.length === 0) document.querySelector('input[value=environment]').disabled = true;
  if (count > 1) {
    element('summary').hidden = false;
    const table = new SummaryTable(data.materials, index => {
      select(index);
      table.select(index);
      element('name').focus();
    });
    table.select(0);
  }
  element('divide').addEventListener('input', event => {
    element('divider').style.setProperty('--at', `${event.target.value}%`);
  });
  const redraw = () => drawPlots(current);
  for (const input of document.querySelectorAll('input[name=channel], #plane-log')) {
    input.addEventListener('change', redraw);
  }
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  element('download').addEventListener('click', () => {
    const blob = new Blob([JSON.stringify(data, null, 1)], {type: 'application/json'});
    const link = make('a', '', {href: URL.createObjectURL(blob), download: 'report.json'});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
  select(0);
}

start();
