// sphere.js: material and fit on a shape under a light that is dragged, evaluated in a fragment shader.

const vertexShader = `#version 300 es
void main() {  // one triangle over all
  gl_Position = vec4(vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0), 0.0, 1.0);
}`;

const maxLights = 64;

// network: GLSL with "vec3 fitted_eval(vec3 wi, vec3 wo)".
const fragmentShader = network => `#version 300 es
${network}
precision highp sampler3D;

uniform sampler3D table;      // log(1 + f / unit)
uniform float unit;
uniform bool showsTable;
uniform bool isTorus;
uniform vec2 corner, size;    // of the picture, pixels
uniform mat3 camera;          // columns: right, up, towards the viewer
uniform int lights;
uniform vec3 directions[${maxLights}];  // to the lights
uniform vec3 irradiances[${maxLights}];
uniform float exposure;
out vec4 shown;

const float pi = 3.14159265358979;

vec3 material_eval(vec3 wi, vec3 wo) {
  if (!(wi.z > 0.0 && wo.z > 0.0)) return vec3(0.0);
  vec3 h = normalize(wi + wo);
  float sine = length(h.xy);
  vec2 phi = sine > 0.0 ? h.xy / sine : vec2(1.0, 0.0);
  vec2 turned = vec2(dot(phi, wi.xy), phi.x * wi.y - phi.y * wi.x);
  vec3 d = vec3(h.z * turned.x - sine * wi.z, turned.y, sine * turned.x + h.z * wi.z);
  float theta_h = atan(sine, h.z), theta_d = atan(length(d.xy), d.z);
  vec3 at = vec3(sqrt(theta_h / (0.5 * pi)), theta_d / (0.5 * pi), atan(d.y, d.x) / pi);
  return unit * (exp(texture(table, at).rgb) - 1.0);
}

// Of the torus: a ring of radius 0.68, tilted, and of a tube of radius 0.3.
const vec3 axis = vec3(0.0, 0.8, 0.6);
vec3 in_its_plane(vec3 p) { return p - dot(p, axis) * axis; }
float torus_distance(vec3 p) { return length(vec2(length(in_its_plane(p)) - 0.68, dot(p, axis))) - 0.3; }

// Where the ray of parallel projection through (x, y) meets the shape: its normal and a tangent there.
bool meets_sphere(vec2 at, out vec3 normal, out vec3 tangent) {
  float rest = 1.0 - dot(at, at);
  if (rest <= 0.0) return false;
  normal = camera * vec3(at, sqrt(rest));
  tangent = vec3(normal.z, 0.0, -normal.x);  // east
  return true;
}
bool meets_torus(vec2 at, out vec3 normal, out vec3 tangent) {
  vec3 p = camera * vec3(at, 2.0);
  float left = 4.0, gap = 1.0;
  for (int step = 0; step < 96 && left > 0.0 && gap > 1e-4; ++step) {
    gap = torus_distance(p);
    p -= gap * camera[2];
    left -= gap;
  }
  if (gap > 1e-3) return false;
  vec3 ring = 0.68 * normalize(in_its_plane(p));
  normal = normalize(p - ring);
  tangent = cross(axis, ring);
  return true;
}

vec3 srgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  vec2 at = 1.12 * (2.0 * (gl_FragCoord.xy - corner) - size) / size.y;
  vec3 normal, tangent;
  bool meets = isTorus ? meets_torus(at, normal, tangent) : meets_sphere(at, normal, tangent);
  shown = vec4(srgb(vec3(0.004)), 1.0);
  if (!meets) return;
  tangent = normalize(dot(tangent, tangent) > 1e-12 ? tangent : vec3(1.0, 0.0, 0.0));
  tangent = normalize(tangent - dot(tangent, normal) * normal);
  mat3 frame = mat3(tangent, cross(normal, tangent), normal);
  vec3 wo = camera[2] * frame, radiance = vec3(0.0);  // v * frame: in the frame
  for (int k = 0; k < lights; ++k) {
    vec3 wi = directions[k] * frame;
    if (wi.z <= 0.0) continue;
    vec3 f = showsTable ? material_eval(wi, wo) : fitted_eval(wi, wo);
    radiance += f * wi.z * irradiances[k];
  }
  shown = vec4(srgb(exposure * radiance), 1.0);
}`;

const noNetwork = `precision highp float;
precision highp int;
vec3 fitted_eval(vec3 wi, vec3 wo) { return vec3(0.0); }`;

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
}

// A unit vector; +y is up, and at yaw 0 it is +z.
function direction({yaw, pitch}) {
  return [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
}

class SphereView {
  // Throws Error where there is no WebGL 2.
  constructor(canvas, environment) {
    this.canvas = canvas;
    this.environment = environment.slice(0, maxLights);
    this.light = {yaw: -0.6, pitch: 0.6};
    this.view = {yaw: 0, pitch: 0};
    this.gl = canvas.getContext('webgl2', {antialias: false, preserveDrawingBuffer: true});
    if (!this.gl) throw new Error('this browser offers no WebGL 2');
    this.gl.bindVertexArray(this.gl.createVertexArray());
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.show(this.material));
    this.listen();
  }

  show(material) {
    this.material = material;
    const {glsl, table} = material.sphere;
    this.program = this.link(fragmentShader(glsl ?? noNetwork));
    if (table) this.loadTable(table);
    this.request();
  }

  link(fragment) {
    const {gl} = this, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const reasons = gl.getAttachedShaders(program).map(shader => gl.getShaderInfoLog(shader)).join(' ');
      throw new Error(`the shader doesn't compile here: ${reasons}`);
    }
    if (this.program) gl.deleteProgram(this.program);
    return program;
  }

  loadTable({size, unit, half_floats}) {
    const {gl} = this;
    this.unit = unit;
    gl.deleteTexture(this.texture);
    this.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_3D, this.texture);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_WRAP_R, gl.REPEAT);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGB16F, ...size, 0, gl.RGB, gl.HALF_FLOAT,
                  new Uint16Array(bytesOf(half_floats).buffer));
  }

  // What the controls beside the canvas say.
  setting(name) { return document.querySelector(`input[name=${name}]:checked`).value; }

  // Drawn before the next frame, once.
  request() {
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame(() => {
      this.requested = false;
      this.draw();
    });
  }

  draw() {
    if (!this.program || this.gl.isContextLost()) return;
    const {gl, canvas} = this;
    // Of each of the two pictures; odd, so that a pixel is in the middle.
    const pixels = Math.min(Math.round(canvas.clientWidth * Math.min(devicePixelRatio, 2) / 2), 480) | 1;
    if (canvas.width !== 2 * pixels) [canvas.width, canvas.height] = [2 * pixels, pixels];
    gl.useProgram(this.program);
    this.setUniforms(pixels);
    gl.clearColor(0.05, 0.05, 0.05, 1);
    gl.viewport(0, 0, 2 * pixels, pixels);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const {glsl, table} = this.material.sphere;
    if (table) this.drawHalf(0, pixels, true);
    if (glsl) this.drawHalf(pixels, pixels, false);
    // For those who test the page.
    canvas.dataset.light = direction(this.light).join(' ');
    canvas.dataset.view = direction(this.view).join(' ');
  }

  drawHalf(left, pixels, showsTable) {
    const {gl} = this;
    gl.uniform2f(this.uniform('corner'), left, 0);
    gl.uniform1i(this.uniform('showsTable'), showsTable);
    gl.viewport(left, 0, pixels, pixels);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  uniform(name) { return this.gl.getUniformLocation(this.program, name); }

  setUniforms(pixels) {
    const {gl} = this, towards = direction(this.view), {yaw} = this.view;
    const right = [Math.cos(yaw), 0, -Math.sin(yaw)];
    const up = [towards[1] * right[2] - towards[2] * right[1], towards[2] * right[0] - towards[0] * right[2],
                towards[0] * right[1] - towards[1] * right[0]];
    gl.uniformMatrix3fv(this.uniform('camera'), false, [...right, ...up, ...towards]);
    gl.uniform2f(this.uniform('size'), pixels, pixels);
    gl.uniform1i(this.uniform('isTorus'), this.setting('shape') === 'torus');
    gl.uniform1i(this.uniform('table'), 0);
    gl.uniform1f(this.uniform('unit'), this.unit ?? 1);
    // One light makes a white diffuse surface that faces it as bright as white.
    const one = this.setting('lighting') === 'one';
    const lights = one ? [{direction: direction(this.light), irradiance: [Math.PI, Math.PI, Math.PI]}] : this.environment;
    gl.uniform1f(this.uniform('exposure'), one ? 1 : this.material.pictures.exposure);
    gl.uniform1i(this.uniform('lights'), lights.length);
    gl.uniform3fv(this.uniform('directions'), lights.flatMap(light => light.direction));
    gl.uniform3fv(this.uniform('irradiances'), lights.flatMap(light => light.irradiance));
  }

  // Moves what the user moves, by angles in radians.
  move(right, up) {
    const moves = this.setting('moves');
    const target = moves === 'view' ? this.view : this.light;
    const sign = moves === 'view' ? -1 : 1;
    target.yaw += sign * right;
    target.pitch = Math.max(-1.5, Math.min(1.5, target.pitch + sign * up));
    this.request();
  }

  listen() {
    const {canvas} = this;
    let last = null;
    canvas.addEventListener('pointerdown', event => {
      last = event;
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', event => {
      if (!last) return;
      const scale = 5 / canvas.clientWidth;
      this.move(scale * (event.clientX - last.clientX), scale * (last.clientY - event.clientY));
      last = event;
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { last = null; });
    const steps = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
    canvas.addEventListener('keydown', event => {
      if (!steps[event.key]) return;
      event.preventDefault();
      this.move(...steps[event.key]);
    });
    for (const input of document.querySelectorAll('#interactive input')) {
      input.addEventListener('change', () => this.request());
    }
    new ResizeObserver(() => this.request()).observe(canvas);
  }
}
