// Drives to begin with, one click each, on ground that ships with the service.
import { button, h } from "../dom";
import { nothingDrawn, store, type Drawn } from "../state";
import { planNow, start } from "../work";
import { checkRequest } from "./request";

interface Example {
  words: string;
  tab: "plan" | "check";
  drawn: Partial<Drawn>;
}

const place = (x_m: number, y_m: number) => ({ x_m, y_m });
const ground = "gale";
const examples: Example[] = [
  { words: "A short drive: a GO", tab: "plan", drawn: { start: place(8142566, -276711), goal: place(8142566, -276696) } },
  { words: "35 m onto ground that no map names", tab: "plan", drawn: { start: place(8142640, -276640), goal: place(8142675, -276650) } },
  { words: "A path onto a slope: a NO-GO, and why", tab: "check", drawn: { path: [place(8142448, -276684), place(8142460, -276684)] } },
];

/** Those on the terrain that is open, if it has any. */
export function examplesView(): HTMLElement {
  const box = h("details", { class: "examples" }, h("summary", {}, "Try an example"),
    examples.map((example) => button(example.words, () => {
      store.draw({ ...nothingDrawn, ...example.drawn });
      store.set({ tab: example.tab, tool: "look", typed: "" });
      if (example.tab === "plan") planNow();
      else void start("v1/checks", checkRequest({ commands: null, soFar: [] }));
    }, { class: "quiet", "data-example": example.words.split(":")[0]! })));
  store.on(["terrain", "drawn"], ({ terrain, drawn }) => {
    box.hidden = terrain?.terrain?.name !== ground;
    if (!drawn.start && !drawn.goal && drawn.path.length === 0) box.open = true;
  });
  return box;
}
