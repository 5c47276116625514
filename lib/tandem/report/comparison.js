// Turns each figure of class "compare" into two pictures on top of each other: a divider to move, a zoom, and the maps
// of the errors. Its images come in pairs, a picture and its map. Without this script the page shows all of them.
"use strict";
for (const figure of document.querySelectorAll("figure.compare")) {
  const images = [...figure.querySelectorAll("img")];
  if (images.length < 4) continue;

  const add = (parent, tag, settings, ...children) => {
    const element = Object.assign(document.createElement(tag), settings);
    element.append(...children);
    parent.append(element);
    return element;
  };
  const labelled = (parent, text, tag, settings) => {
    const label = add(parent, "label", {}, text + " ");
    return add(label, tag, settings);
  };

  figure.querySelector(".pictures").hidden = true;
  figure.querySelector(".pictures").style.display = "none";
  const controls = add(figure, "div", { className: "controls" });
  const choices = [labelled(controls, "Left", "select", {}), labelled(controls, "Right", "select", {})];
  for (const choice of choices) {
    for (let i = 0; i < images.length; i += 2) add(choice, "option", { value: i }, images[i].alt);
  }
  choices[1].selectedIndex = 1;
  const maps = labelled(controls, "Error maps", "input", { type: "checkbox", className: "maps" });
  const zoom = labelled(controls, "Zoom", "input", { type: "range", className: "zoom", min: 1, max: 16, step: 0.5, value: 1 });

  const split = add(figure, "input", { type: "range", className: "split", min: 0, max: 1000, value: 500, ariaLabel: "Divider" });
  const stage = add(figure, "div", { className: "stage", tabIndex: 0 });
  const layers = add(stage, "div", { className: "layers" });
  const pictures = [add(layers, "img", { className: "left" }), add(layers, "img", { className: "right" })];
  const caption = add(figure, "figcaption", {});

  const show = () => {
    pictures.forEach((picture, side) => {
      const source = images[Number(choices[side].value) + (maps.checked ? 1 : 0)];
      picture.src = source.src;
      picture.alt = source.alt;
    });
    // The middle of what is in view stays where it is
    const middle = (stage.scrollLeft + stage.clientWidth / 2) / Math.max(layers.clientWidth, 1);
    const height = (stage.scrollTop + stage.clientHeight / 2) / Math.max(layers.clientHeight, 1);
    layers.style.width = 100 * zoom.value + "%";
    stage.scrollLeft = middle * layers.clientWidth - stage.clientWidth / 2;
    stage.scrollTop = height * layers.clientHeight - stage.clientHeight / 2;
    divide();
  };
  // The divider is a share of what is in view, so that it can be reached at every zoom
  const divide = () => {
    const at = stage.scrollLeft + (stage.clientWidth * split.value) / 1000;
    const share = (100 * at) / Math.max(layers.clientWidth, 1);
    pictures[1].style.clipPath = `inset(0 0 0 ${share}%)`;
    caption.textContent = `Left of the divider: ${pictures[0].alt}. Right: ${pictures[1].alt}.`;
  };
  for (const control of [...choices, maps, zoom]) control.addEventListener("input", show);
  split.addEventListener("input", divide);
  stage.addEventListener("scroll", divide);
  stage.addEventListener("pointermove", (event) => {
    if (event.buttons !== 1) return;
    const left = stage.getBoundingClientRect().left;
    split.value = (1000 * (event.clientX - left)) / stage.clientWidth;
    divide();
  });
  layers.addEventListener("dragstart", (event) => event.preventDefault());
  show();
}
