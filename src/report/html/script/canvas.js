// WebGL 2: the parts, the section plane through them, their edges, and light as ribbons.

const FACE_VERTEX = `#version 300 es
in vec3 corner; in vec3 normal; uniform mat4 matrix; out vec3 place; out vec3 upright;
void main() { place = corner; upright = normal; gl_Position = matrix * vec4(corner, 1.0); }`;
const FACE_COLOUR = `#version 300 es
precision highp float;
in vec3 place; in vec3 upright; uniform vec4 front; uniform vec4 back; uniform vec4 plane; uniform vec3 sight; out vec4 colour;
void main() {
  if (dot(plane.xyz, place) > plane.w) discard;
  vec4 base = gl_FrontFacing ? front : back;
  float facing = abs(dot(normalize(upright + 1e-20), sight));
  colour = vec4(base.rgb * (0.45 + 0.55 * facing), 1.0) * mix(base.a, min(1.0, 2.2 * base.a), base.a < 1.0 ? pow(1.0 - facing, 2.0) : 0.0);
}`;
const LINE_VERTEX = `#version 300 es
in vec3 corner; uniform mat4 matrix; out vec3 place;
void main() { place = corner; gl_Position = matrix * vec4(corner, 1.0); }`;
const LINE_COLOUR = `#version 300 es
precision highp float;
in vec3 place; uniform vec4 ink; uniform vec4 plane; out vec4 colour;
void main() { if (dot(plane.xyz, place) > plane.w) discard; colour = vec4(ink.rgb, 1.0) * ink.a; }`;
// A segment becomes a ribbon of constant width on the screen.
const RIBBON_VERTEX = `#version 300 es
in vec2 side; in vec3 from; in vec3 to; in vec4 tint; uniform mat4 matrix; uniform vec2 pixel; uniform float width; uniform float nearer; out vec4 shade;
void main() {
  vec4 a = matrix * vec4(from, 1.0); vec4 b = matrix * vec4(to, 1.0);
  vec2 along = (b.xy - a.xy) / pixel; float size = length(along);
  along = size > 0.0 ? along / size : vec2(1.0, 0.0);
  vec4 end = side.x > 0.5 ? b : a;
  gl_Position = vec4(end.xy + pixel * width * side.y * vec2(-along.y, along.x), end.z - nearer, 1.0); shade = tint;
}`;
const RIBBON_COLOUR = `#version 300 es
precision highp float;
in vec4 shade; out vec4 colour;
void main() { colour = vec4(shade.rgb, 1.0) * shade.a; }`;

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const at = (name) => gl.getUniformLocation(made, name);
  return { made, at, input: (name) => gl.getAttribLocation(made, name) };
}

// A vertex array over one buffer; inputs as [name, numbers], `each`: 1 if they are per instance.
function strip(gl, program, data, inputs, each = 0, array = gl.createVertexArray()) {
  const buffer = gl.createBuffer();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  const stride = 4 * inputs.reduce((sum, [, numbers]) => sum + numbers, 0);
  let offset = 0;
  for (const [name, numbers] of inputs) {
    const at = program.input(name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, numbers, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(at, each);
    offset += 4 * numbers;
  }
  return { array, buffer };
}

// The painter of a canvas, or null without WebGL 2. `paint(camera, look)` draws; look: colours [front, back] and opacity of each part,
// plane, fills (media in a section), ribbons, edges.
function makePainter(canvas, drawing, form, lines) {
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, stencil: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  const face = program(gl, FACE_VERTEX, FACE_COLOUR);
  const line = program(gl, LINE_VERTEX, LINE_COLOUR);
  const ribbon = program(gl, RIBBON_VERTEX, RIBBON_COLOUR);
  const solid = gl.createVertexArray();
  strip(gl, face, form.places, [["corner", 3]], 0, solid);
  strip(gl, face, form.smooth, [["normal", 3]], 0, solid);
  const rims = strip(gl, line, lines.ends, [["corner", 3]]);
  const quad = new Float32Array([0, -0.5, 1, -0.5, 0, 0.5, 1, 0.5]);
  const sheet = gl.createVertexArray();
  const corners = strip(gl, face, new Float32Array(12), [["corner", 3]], 0, sheet);

  const ribbons = (segments) => {
    const made = strip(gl, ribbon, quad, [["side", 2]]);
    strip(gl, ribbon, segments, [["from", 3], ["to", 3], ["tint", 4]], 1, made.array);
    return { array: made.array, count: segments.length / 10 };
  };
  const trianglesOf = (part) => gl.drawArrays(gl.TRIANGLES, 3 * part.first, 3 * part.triangles);

  function faces(look, which) {
    gl.bindVertexArray(solid);
    for (const part of drawing.parts) {
      const { front, back } = look.parts[part.index];
      if (part.hidden || part.triangles === 0 || !which(front[3])) continue;
      gl.uniform4fv(face.at("front"), front);
      gl.uniform4fv(face.at("back"), back);
      trianglesOf(part);
    }
  }

  // Where a section cuts solids of a medium: beyond the plane their backs and fronts are counted, and what is left over is inside.
  function fill(look) {
    for (const { parts, colour } of look.fills) {
      gl.clear(gl.STENCIL_BUFFER_BIT);
      gl.enable(gl.STENCIL_TEST);
      gl.colorMask(false, false, false, false);
      gl.depthMask(false);
      gl.disable(gl.DEPTH_TEST);
      gl.stencilFunc(gl.ALWAYS, 0, 255);
      gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, gl.INCR_WRAP);
      gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.DECR_WRAP);
      gl.bindVertexArray(solid);
      parts.filter((part) => !part.hidden).forEach(trianglesOf);
      gl.colorMask(true, true, true, true);
      gl.depthMask(true);
      gl.enable(gl.DEPTH_TEST);
      gl.stencilFunc(gl.NOTEQUAL, 0, 255);
      gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
      gl.uniform4fv(face.at("plane"), [0, 0, 0, 1]);
      gl.uniform4fv(face.at("front"), colour);
      gl.uniform4fv(face.at("back"), colour);
      gl.bindVertexArray(sheet);
      gl.vertexAttrib3fv(face.input("normal"), look.sight);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
      gl.uniform4fv(face.at("plane"), look.plane);
      gl.disable(gl.STENCIL_TEST);
    }
  }

  function ribbonsOf(camera, look) {
    gl.useProgram(ribbon.made);
    gl.uniformMatrix4fv(ribbon.at("matrix"), false, camera.matrix());
    gl.uniform2f(ribbon.at("pixel"), 2 / canvas.width, 2 / canvas.height);
    for (const { array, count, width, nearer } of look.ribbons) {
      gl.uniform1f(ribbon.at("width"), width * look.scale);
      gl.uniform1f(ribbon.at("nearer"), nearer);
      gl.bindVertexArray(array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
  }

  function edgesOf(camera, look) {
    gl.useProgram(line.made);
    gl.uniformMatrix4fv(line.at("matrix"), false, camera.matrix());
    gl.uniform4fv(line.at("plane"), look.plane);
    gl.bindVertexArray(rims.array);
    for (const part of drawing.parts) {
      const [first, count] = lines.ranges[part.index];
      if (part.hidden || count === 0) continue;
      gl.uniform4fv(line.at("ink"), look.parts[part.index].edge);
      gl.drawArrays(gl.LINES, first, count);
    }
  }

  function paint(camera, look) {
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...look.paper, 1);
    gl.clearStencil(0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    const opened = () => {
      gl.useProgram(face.made);
      gl.uniformMatrix4fv(face.at("matrix"), false, camera.matrix());
      gl.uniform4fv(face.at("plane"), look.plane);
      gl.uniform3fv(face.at("sight"), camera.turn[2]);
    };
    opened();
    faces(look, (opacity) => opacity >= 1);
    if (look.cut) {
      gl.bindBuffer(gl.ARRAY_BUFFER, corners.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, look.cut, gl.DYNAMIC_DRAW);
      fill(look);
    }
    if (look.edges) edgesOf(camera, look);
    ribbonsOf(camera, look);
    opened();
    gl.depthMask(false);
    faces(look, (opacity) => opacity < 1);
    gl.depthMask(true);
  }
  return { paint, ribbons, free: ({ array }) => gl.deleteVertexArray(array) };
}
