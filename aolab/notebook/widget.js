// The browser side of the widget aolab.glyph_picker (anywidget). It shows an image, sends the clicked pixel to Python,
// and shows the picture and message that Python sets. Pixels are (column, row), from the top left; the image may be
// scaled.

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const STRIDE = 10; // pixels per arrow key with Shift

function make(tag, style, attributes = {}) {
  const element = Object.assign(document.createElement(tag), attributes);
  element.style.cssText = style;
  return element;
}

function show(image, bytes) {
  URL.revokeObjectURL(image.src);
  image.style.display = bytes.byteLength ? "block" : "none";
  if (bytes.byteLength) image.src = URL.createObjectURL(new Blob([bytes], { type: "image/png" }));
  else image.removeAttribute("src");
}

function render({ model, el }) {
  const image = make("img", "max-width: 100%; cursor: crosshair", { draggable: false });
  const marker = make("div", `position: absolute; width: 9px; height: 9px; transform: translate(-50%, -50%);
    border: 1.5px solid white; border-radius: 50%; outline: 1.5px solid black; pointer-events: none`);
  const stage = make("div", "position: relative; max-width: 100%; align-self: flex-start", { tabIndex: 0 });
  stage.setAttribute("role", "application");
  stage.setAttribute("aria-label", "Rendered image. Arrow keys move the chosen pixel, with Shift by ten.");
  stage.append(image, marker);
  const picture = make("img", "max-width: 100%");
  const message = make("div", "max-width: 36em; padding: 4px 0");
  message.setAttribute("role", "status"); // screen readers read it when it changes
  const answer = make("div", "max-width: 100%");
  answer.append(picture, message);
  const both = make("div", "display: flex; flex-wrap: wrap; gap: 8px");
  both.append(stage, answer);
  el.append(both);

  function choose(column, row) {
    const clamp = (value, size) => Math.min(Math.max(Math.floor(value), 0), size - 1);
    model.set("pixel", [clamp(column, image.naturalWidth), clamp(row, image.naturalHeight)]);
    model.save_changes();
  }

  image.addEventListener("click", (event) => {
    const shown = image.getBoundingClientRect(); // the size on the page, after layout and zoom
    choose(
      ((event.clientX - shown.left) / shown.width) * image.naturalWidth,
      ((event.clientY - shown.top) / shown.height) * image.naturalHeight,
    );
  });

  stage.addEventListener("keydown", (event) => {
    const step = STEPS[event.key];
    if (!step || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault(); // the page must not scroll
    event.stopPropagation(); // the notebook must not select another cell
    const [column, row] = model.get("pixel") ?? [image.naturalWidth / 2, image.naturalHeight / 2];
    const stride = event.shiftKey ? STRIDE : 1;
    choose(column + stride * step[0], row + stride * step[1]);
  });

  function mark() {
    const pixel = model.get("pixel");
    marker.hidden = !pixel || !image.naturalWidth;
    if (marker.hidden) return;
    marker.style.left = `${((pixel[0] + 0.5) / image.naturalWidth) * 100}%`;
    marker.style.top = `${((pixel[1] + 0.5) / image.naturalHeight) * 100}%`;
  }

  function answered() {
    show(picture, model.get("picture"));
    message.textContent = picture.alt = model.get("message");
  }

  image.alt = "The rendered image";
  image.addEventListener("load", mark);
  show(image, model.get("image"));
  mark();
  answered();
  model.on("change:pixel", mark);
  model.on("change:picture change:message", answered);
  return () => {
    model.off("change:pixel", mark);
    model.off("change:picture change:message", answered);
    for (const shown of [image, picture]) URL.revokeObjectURL(shown.src);
  };
}

export default { render };
