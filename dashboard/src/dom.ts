// Builds elements without markup in strings, so that no text of a document can become HTML.

type Child = Node | string | number | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: Event) => void)>;

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Child | Child[])[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name.replace(/^on/, ""), value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  append(element, children);
  return element;
}

/** The same for a drawing. */
export function svg(tag: string, attributes: Record<string, string | number>, ...children: SVGElement[]): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

function append(element: HTMLElement, children: (Child | Child[])[]): void {
  for (const child of children.flat()) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child instanceof Node ? child : String(child));
  }
}

/** Takes the place of all that is in the element. */
export function fill(element: HTMLElement, ...children: (Child | Child[])[]): void {
  element.replaceChildren();
  append(element, children);
}

/** What a closed part of the page holds is made when it is opened, and kept up to date as long as it is. */
export function folded(element: HTMLDetailsElement, summary: () => string, content: () => Child[]): () => void {
  const head = h("summary"); // which stays, so that the keyboard's focus does
  const body = h("div");
  element.append(head, body);
  const draw = () => {
    head.textContent = summary();
    fill(body, element.open ? content() : null);
  };
  element.addEventListener("toggle", draw);
  return draw;
}

let labels = 0;

/** A label with its field; the field's name for screen readers is the label's text. */
export function field<E extends HTMLElement>(label: string, control: E, hint?: string | (string | Node)[]): HTMLElement {
  control.id ||= `field-${++labels}`;
  const described = hint ? h("small", { id: `${control.id}-hint` }, hint) : null;
  if (described) control.setAttribute("aria-describedby", described.id);
  return h("div", { class: "field" }, h("label", { for: control.id }, label), control, described);
}

export function button(text: string, press: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h("button", { type: "button", onclick: press, ...attributes }, text);
}

export function select(
  options: { value: string; text: string }[],
  chosen: string,
  change: (value: string) => void,
): HTMLSelectElement {
  const element = h(
    "select",
    { onchange: () => change(element.value) },
    options.map((o) => h("option", { value: o.value, selected: o.value === chosen }, o.text)),
  );
  return element;
}

/** A coloured square beside a word of a legend. A colour set from script is what the page's policy allows. */
export function swatch(colour: string | null, shape = ""): HTMLElement {
  const square = h("span", { class: colour ? `swatch ${shape}` : "swatch hatched", "aria-hidden": "true" });
  if (colour) square.style.backgroundColor = colour;
  return square;
}
