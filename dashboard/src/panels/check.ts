// May this be commanded? A path or a command sequence, drawn, pasted or read from a file.
import { asCurl } from "../api/client";
import { button, field, fill, h } from "../dom";
import { readPlace } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { problemView } from "../problem";
import { store } from "../state";
import { start } from "../work";
import { options } from "./options";
import { readPathText } from "./path_text";
import { toolBar, zones } from "./plan";
import { checkRequest, type Command } from "./request";

export function checkPanel(target: HTMLElement, map: TerrainMap): void {
  const common = h("div");
  options(common);
  const fault = h("div");
  const text = h("textarea", { rows: 6, spellcheck: "false", placeholder: "8142579.7, -276648.7\n8142578, -276680\n\nor: drive=10 turn=30 arc=6,8" });
  const file = h("input", { type: "file", accept: ".csv,.json,.geojson,.txt", onchange: () => void take() });
  const place = h("input", { placeholder: "x, y in metres", autocomplete: "off", id: "check-start" });
  const heading = h("input", { type: "number", step: "any", value: 0, id: "check-yaw" });
  const startFields = h("div", { class: "columns" }, field("Start of the commands", place), field("Heading, deg (left of east)", heading));
  const curl = h("details");
  let commands: Command[] | null = null;

  async function take(): Promise<void> {
    const chosen = file.files?.[0];
    if (!chosen) return;
    text.value = (await chosen.text()).slice(0, 1_000_000);
    read();
  }

  /** What is in the field becomes the path on the map, or the commands. */
  function read(): boolean {
    fill(fault);
    try {
      const found = readPathText(text.value, map.body);
      commands = found.commands ?? null;
      store.draw({ path: found.path ?? [] });
      show();
      return true;
    } catch (error) {
      fill(fault, problemView((error as Error).message));
      return false;
    }
  }

  function request(): Record<string, unknown> {
    const from = readPlace(place.value) ?? store.state.drawn.start;
    return checkRequest(commands ? { start: { ...(from ?? { x_m: NaN, y_m: NaN }), yaw_deg: Number(heading.value) || 0 }, list: commands } : null);
  }

  function show(): void {
    startFields.hidden = commands === null;
    const open = curl.open;
    fill(curl, h("summary", {}, "The request as a command"), h("pre", { tabindex: 0 }, asCurl("v1/checks", request())));
    curl.open = open;
  }

  function check(): void {
    if (text.value.trim() !== "" && !read()) return;
    if (commands && !(readPlace(place.value) ?? store.state.drawn.start)) {
      fill(fault, problemView("Commands need a start: type it, or set it on the map under Plan."));
      place.focus();
      return;
    }
    if (!commands && store.state.drawn.path.length < 2) {
      fill(fault, problemView("A path has two corners or more: click them on the map, or paste them."));
      return;
    }
    void start("v1/checks", request());
  }

  store.on(["drawn", "options", "terrain"], show);
  const corner = h("button", { type: "button", "data-tool": "corner", onclick: () => {
    commands = null;
    text.value = "";
    store.set({ tool: store.state.tool === "corner" ? "look" : "corner" });
  } }, "Click corners");
  store.on(["tool"], ({ tool }) => corner.setAttribute("aria-pressed", String(tool === "corner")));
  fill(
    target,
    common,
    h("h2", {}, "Path or commands"),
    h("div", { class: "row" }, corner, button("Remove the path", () => {
      commands = null;
      text.value = "";
      store.draw({ path: [] });
    }, { class: "quiet" })),
    field("Corners as CSV or GeoJSON, or commands", text, "A CSV has columns x_m and y_m. Commands are drive=METRES, turn=DEGREES, arc=METRES,RADIUS; left is positive."),
    field("or a file", file),
    startFields,
    h("h2", {}, "Zones"),
    toolBar(["keep_out", "keep_in"]),
    zones(),
    fault,
    button("Check the drive", check, { class: "primary", "data-do": "check" }),
    curl,
  );
}
