// The browser side of the widget aolab.explore (anywidget). It builds controls from `statement`, sends `wish`, and shows
// `reply` and `picture`. At most one wish is unanswered: meanwhile the latest one waits here, and older ones are dropped.

const REST = 250; // milliseconds without a change until the picture at rest is rendered
const SLOP = 4; // CSS pixels: a shorter drag is a click
const DEGREES_PER_PIXEL = 0.4;
const STEPS = 1000; // of a slider

function make(tag, style, attributes = {}, ...children) {
  const element = Object.assign(document.createElement(tag), attributes);
  element.style.cssText = style;
  element.append(...children);
  return element;
}

// The value at a slider's position 0..STEPS, and the inverse.
function valueAt(control, position) {
  const share = position / STEPS;
  const { low, high, log, kind } = control;
  const value = log ? low * (high / low) ** share : low + (high - low) * share;
  return kind === "int" ? Math.round(value) : Number(value.toPrecision(4));
}

function positionOf(control, value) {
  const { low, high, log } = control;
  const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(Math.min(Math.max(share, 0), 1) * STEPS);
}

function showBytes(image, bytes) {
  if (image.src) URL.revokeObjectURL(image.src);
  image.style.display = bytes.byteLength ? "block" : "none";
  if (bytes.byteLength) image.src = URL.createObjectURL(new Blob([bytes]));
  else image.removeAttribute("src");
}

function menu(values, value, label, changed) {
  const select = make("select", "max-width: 100%");
  select.setAttribute("aria-label", label);
  const fill = (names, chosen) => {
    if (names.join() !== [...select.options].map((option) => option.value).join())
      select.replaceChildren(...names.map((name) => make("option", "", { value: name, textContent: name })));
    select.value = chosen;
  };
  fill(values, value);
  select.addEventListener("change", () => changed(select.value));
  return { select, fill };
}

function render({ model, el }) {
  const statement = model.get("statement");
  const first = model.get("wish");
  const own = new AbortController();
  const on = (target, name, heard, more) => target.addEventListener(name, heard, { ...more, signal: own.signal });

  // --- one frame in flight, the latest wish wins

  const values = { [first.module]: { ...first.parameters } }; // of each module, those that differ from the defaults
  const want = { module: first.module, buffer: "", view: "result", azimuth: 0, elevation: 0, zoom: 1, pixel: null };
  let sent = first.number ?? 0, flying = false, pending = null, timer = 0;

  function ask(moving) {
    clearTimeout(timer);
    pending = { ...want, parameters: values[want.module] ?? {}, moving };
    if (moving) timer = setTimeout(() => ask(false), REST);
    if (!flying) send();
  }

  function send() {
    flying = true;
    sent = Math.max(sent, model.get("wish").number ?? 0) + 1;
    model.set("wish", { ...pending, number: sent });
    pending = null;
    model.save_changes();
  }

  // --- the page

  const picture = make("img", "display: block; max-width: 100%; cursor: grab; touch-action: none", { draggable: false });
  const marker = make("div", `position: absolute; width: 9px; height: 9px; transform: translate(-50%, -50%);
    border: 1.5px solid white; border-radius: 50%; outline: 1.5px solid black; pointer-events: none`, { hidden: true });
  const bar = make("img", "display: none", { alt: "colour bar" });
  const stage = make("div", "position: relative", { tabIndex: 0 }, picture, marker);
  stage.setAttribute("role", "application");
  stage.setAttribute("aria-label", "Render. Arrow keys orbit the camera, plus and minus zoom, Home resets.");
  const status = make("div", "padding: 4px 0; min-height: 1.4em");
  status.setAttribute("role", "status");
  const failure = make("div", "color: #b00020; white-space: pre-wrap");
  failure.setAttribute("role", "alert");
  const timings = make("details", "", {}, make("summary", "", { textContent: "timings" }));
  const passes = make("pre", "margin: 0");
  timings.append(passes);
  const code = make("input", "flex: 1; min-width: 8em; font-family: monospace", { readOnly: true, ariaLabel: "code" });
  const copy = make("button", "", { textContent: "Copy as code", type: "button" });
  const samples = make("img", "display: none; max-width: 100%");
  const told = make("div", "white-space: pre-wrap; font-family: monospace; font-size: 12px");

  const modules = menu(Object.keys(statement), want.module, "module", (name) => {
    want.module = name;
    want.pixel = null;
    build();
    ask(false);
  });
  const buffers = menu([], "", "buffer", (name) => { want.buffer = name; ask(false); });
  const views = menu(["result", "truth", "error"], "result", "view", (name) => { want.view = name; ask(false); });
  const sliders = make("div", "max-height: 320px; overflow-y: auto; padding-right: 6px");
  const panel = make("div", "width: 300px", {},
    make("div", "display: flex; gap: 6px; flex-wrap: wrap; margin-bottom: 6px", {}, modules.select, buffers.select, views.select),
    sliders);
  const left = make("div", "flex: 0 1 auto; width: 580px; max-width: 100%", {},
    make("div", "display: flex; gap: 4px; align-items: flex-start", {}, stage, bar), status, failure, timings,
    make("div", "display: flex; gap: 6px; margin: 4px 0", {}, code, copy));
  const below = make("div", "display: none", {}, told, samples);
  el.append(make("div", "display: flex; flex-wrap: wrap; gap: 12px", {}, left, panel), below);

  // --- the controls of the parameters

  function build() {
    const mine = values[want.module] ?? {};
    const chosen = (axis) => mine[axis] ?? statement[want.module].find((control) => control.name === axis)?.default;
    const there = statement[want.module].filter((control) => !control.with || chosen(control.with[0]) === control.with[1]);
    sliders.replaceChildren(...there.map(line));
  }

  function set(control, value, moving) {
    const mine = (values[want.module] ??= {});
    if (value === control.default) delete mine[control.name];
    else mine[control.name] = value;
    ask(moving);
  }

  function line(control) {
    const mine = values[want.module] ?? {};
    const value = control.name in mine ? mine[control.name] : control.default;
    const label = make("label", "display: block; font-size: 12px; margin-top: 4px", { title: control.description });
    const unit = control.unit ? ` (${control.unit})` : "";
    const number = make("output", "float: right");
    label.append(`${control.name}${unit} `, number);
    if (control.kind === "choice") {
      const choice = menu(control.choices.map(String), String(value), control.name, (text) => {
        set(control, control.choices.find((one) => String(one) === text), false);
        build(); // another occluder kind or filter has other parameters
      });
      label.append(choice.select);
    } else if (control.kind === "bool") {
      const box = make("input", "", { type: "checkbox", checked: value });
      box.addEventListener("change", () => set(control, box.checked, false));
      label.append(box);
    } else if (control.kind === "text") {
      const box = make("input", "width: 100%", { value });
      box.addEventListener("change", () => set(control, box.value, false));
      label.append(box);
    } else {
      const slider = make("input", "width: 100%; display: block", { type: "range", min: 0, max: STEPS, name: control.name });
      slider.setAttribute("aria-label", control.name);
      const shown = (now) => {
        number.textContent = now;
        slider.value = positionOf(control, now === "auto" ? control.resolved : now);
      };
      shown(value);
      slider.addEventListener("input", () => {
        const now = valueAt(control, Number(slider.value));
        number.textContent = now;
        set(control, now, true);
      });
      slider.addEventListener("change", () => ask(false));
      label.addEventListener("dblclick", () => { shown(control.default); set(control, control.default, false); });
      label.append(slider);
    }
    return label;
  }

  // --- the camera: drag, wheel, keys; and the clicked pixel

  let drag = null;
  function orbit(azimuth, elevation, zoom = 1) {
    want.azimuth += azimuth;
    want.elevation = Math.min(Math.max(want.elevation + elevation, -180), 180);
    want.zoom = Math.min(Math.max(want.zoom * zoom, 0.05), 50);
    want.pixel = null;
    ask(true);
  }
  function home() {
    Object.assign(want, { azimuth: 0, elevation: 0, zoom: 1, pixel: null });
    ask(false);
  }

  on(picture, "pointerdown", (event) => {
    if (event.button) return;
    drag = { x: event.clientX, y: event.clientY, moved: false };
    if (event.isTrusted) picture.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true });
  });
  on(picture, "pointermove", (event) => {
    if (!drag) return;
    const dx = event.clientX - drag.x, dy = event.clientY - drag.y;
    if (!drag.moved && Math.hypot(dx, dy) < SLOP) return;
    Object.assign(drag, { x: event.clientX, y: event.clientY, moved: true });
    orbit(-dx * DEGREES_PER_PIXEL, dy * DEGREES_PER_PIXEL);
  });
  on(picture, "pointerup", (event) => {
    if (drag && !drag.moved) {
      const shown = picture.getBoundingClientRect(), [width, height] = model.get("reply").size;
      const clamp = (share, size) => Math.min(Math.max(Math.floor(share * size), 0), size - 1);
      want.pixel = [
        clamp((event.clientX - shown.left) / shown.width, width),
        clamp((event.clientY - shown.top) / shown.height, height),
      ];
      ask(false);
    } else if (drag) ask(false);
    drag = null;
  });
  on(picture, "pointercancel", () => { drag = null; });
  on(picture, "dblclick", home);
  on(stage, "wheel", (event) => {
    if (document.activeElement !== stage && !stage.contains(document.activeElement)) return; // the page scrolls
    event.preventDefault();
    orbit(0, 0, Math.exp(-event.deltaY / 800));
  }, { passive: false });
  const keys = {
    ArrowLeft: () => orbit(-5, 0), ArrowRight: () => orbit(5, 0), ArrowUp: () => orbit(0, 5), ArrowDown: () => orbit(0, -5),
    "+": () => orbit(0, 0, 1.1), "-": () => orbit(0, 0, 1 / 1.1), Home: home,
  };
  on(stage, "keydown", (event) => {
    if (!keys[event.key] || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault(); // the page must not scroll
    event.stopPropagation(); // the notebook must not select another cell
    keys[event.key]();
  });
  on(copy, "click", async () => {
    code.select();
    try { await navigator.clipboard.writeText(code.value); } catch { document.execCommand("copy"); }
    copy.textContent = "Copied";
    setTimeout(() => { copy.textContent = "Copy as code"; }, 1500);
  });

  // --- answers

  function answered() {
    const reply = model.get("reply");
    failure.textContent = reply.error;
    if (!reply.error) {
      status.textContent = picture.alt = reply.text;
      code.value = reply.code;
      passes.textContent = reply.timings.map(([step, ms]) => `${step.padEnd(22)}${ms.toFixed(1).padStart(8)} ms`).join("\n");
      buffers.fill(reply.buffers, reply.buffer);
      picture.style.width = `${reply.size[0]}px`; // a smaller picture, while moving, is enlarged
      picture.style.aspectRatio = `${reply.size[0]} / ${reply.size[1]}`;
      const pixel = want.pixel;
      marker.hidden = !pixel;
      if (pixel) {
        marker.style.left = `${((pixel[0] + 0.5) / reply.size[0]) * 100}%`;
        marker.style.top = `${((pixel[1] + 0.5) / reply.size[1]) * 100}%`;
      }
      told.textContent = pixel ? reply.samples ?? "" : "";
      below.style.display = pixel ? "block" : "none";
    }
    if (reply.number < sent) return;
    flying = false;
    if (pending) send();
  }
  const pictured = () => { showBytes(picture, model.get("picture")); showBytes(bar, model.get("bar")); };
  const sampled = () => showBytes(samples, model.get("samples"));

  build();
  pictured();
  sampled();
  answered();
  model.on("change:reply", answered);
  model.on("change:picture change:bar", pictured);
  model.on("change:samples", sampled);
  return () => {
    clearTimeout(timer);
    own.abort();
    model.off("change:reply", answered);
    model.off("change:picture change:bar", pictured);
    model.off("change:samples", sampled);
    for (const shown of [picture, bar, samples]) if (shown.src) URL.revokeObjectURL(shown.src);
  };
}

export default { render };
