// May this be commanded? A path or a command sequence, drawn, pasted or read from a file.
import { asCurl, type CheckRequest } from "../api/client";
import { button, field, fill, folded, h } from "../dom";
import { readPlace } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { problemView } from "../problem";
import { store } from "../state";
import { start } from "../work";
import { examplesView } from "./examples";
import { options } from "./options";
import { readPathText, readTelemetry } from "./path_text";
import { toolBar, zones } from "./plan";
import { checkRequest, type Command, type Telemetry } from "./request";

export function checkPanel(target: HTMLElement, map: TerrainMap): void {
  const common = h("div");
  options(common, "check");
  const fault = h("div");
  const text = h("textarea", { rows: 6, oninput: () => peek(), onchange: () => void (text.value.trim() !== "" && read()), spellcheck: "false", placeholder: "8142579.7, -276648.7\n8142578, -276680\n\nor: drive=10 turn=30 arc=6,8" });
  const file = h("input", { type: "file", accept: ".csv,.json,.geojson,.txt", onchange: () => void take() });
  const place = h("input", { placeholder: "x, y in metres, or degrees: 137.4 E, 4.7 S", autocomplete: "off", id: "check-start", onchange: () => tellTyped() });
  const heading = h("input", { type: "number", step: "any", value: 0, id: "check-yaw", onchange: () => tellTyped() });
  const startFields = h("div", { class: "columns" }, field("Start of the commands", place), field("Heading, deg (left of east)", heading));
  const telemetry = h("textarea", { rows: 5, oninput: () => tellTyped(), spellcheck: "false", placeholder: "driven_m,x_m,y_m,current_a\n0,8142640,-276640,\n2.4,8142638,-276640.3,6.1" });
  const telemetryFile = h("input", { type: "file", accept: ".csv", onchange: () => void telemetryFile.files?.[0]?.text().then((t) => (telemetry.value = t.slice(0, 1_000_000))) });
  const curl = h("details");
  const drawCurl = folded(curl, () => "The request as a command", () => [h("pre", { tabindex: 0 }, asCurl("v1/checks", request()))]);
  let commands: Command[] | null = null;
  let soFar: Telemetry = [];

  async function take(): Promise<void> {
    const chosen = file.files?.[0];
    if (!chosen) return;
    text.value = (await chosen.text()).slice(0, 1_000_000);
    read();
  }

  /** Whether commands are being typed, which need a start. */
  function peek(): void {
    fill(fault);
    commands = null;
    try {
      commands = readPathText(text.value, map.body).commands ?? null;
    } catch {
      // It is not whole yet.
    }
    startFields.hidden = commands === null;
    tellTyped();
  }

  /** What is in the field becomes the path on the map, or the commands. */
  function read(): boolean {
    fill(fault);
    try {
      const found = readPathText(text.value, map.body);
      commands = found.commands ?? null;
      store.draw({ path: found.path ?? [] });
      tellTyped();
      show();
      return true;
    } catch (error) {
      fill(fault, problemView((error as Error).message));
      return false;
    }
  }

  function request(): CheckRequest {
    const from = readPlace(place.value, map.body) ?? store.state.drawn.start;
    const start = from ? { start: { ...from, yaw_deg: Number(heading.value) || 0 } } : {};
    return checkRequest({ commands: commands ? { ...start, list: commands } : null, soFar });
  }

  /** What the map does not show of the question. */
  function tellTyped(): void {
    store.set({ typed: [commands ? [text.value, place.value, heading.value] : [], telemetry.value].flat().join("\n").trim() });
  }

  function show(): void {
    startFields.hidden = commands === null;
    drawCurl();
  }

  function check(): void {
    if (text.value.trim() !== "" && !read()) return;
    try {
      soFar = telemetry.value.trim() === "" ? [] : readTelemetry(telemetry.value);
    } catch (error) {
      fill(fault, problemView((error as Error).message));
      return;
    }
    if (commands && soFar.length === 0 && !(readPlace(place.value, map.body) ?? store.state.drawn.start)) {
      fill(fault, problemView("Commands need a start: type it, or set it on the map under Plan."));
      place.focus();
      return;
    }
    if (!commands && store.state.drawn.path.length < (soFar.length > 0 ? 1 : 2)) {
      fill(fault, problemView("A path has two corners or more: click them on the map, or paste them."));
      return;
    }
    void start("v1/checks", request());
  }

  store.on(["drawn", "options", "terrain"], show);
  const corner = h("button", { type: "button", "data-tool": "corner", onclick: () => {
    commands = null;
    text.value = "";
    tellTyped();
    store.set({ tool: store.state.tool === "corner" ? "look" : "corner" });
  } }, "Click corners");
  store.on(["tool"], ({ tool }) => corner.setAttribute("aria-pressed", String(tool === "corner")));
  fill(
    target,
    examplesView(),
    common,
    h("h2", {}, "Path or commands"),
    h("div", { class: "row" }, corner, button("Remove the path", () => {
      commands = null;
      text.value = "";
      tellTyped();
      store.draw({ path: [] });
    }, { class: "quiet" })),
    field("Corners as CSV or GeoJSON, or commands", text, ["A CSV has columns ", h("code", {}, "x_m"), " and ", h("code", {}, "y_m"), ". Commands are drive=METRES, turn=DEGREES, arc=METRES,RADIUS; left is positive."]),
    field("or a file", file),
    startFields,
    h("details", {}, h("summary", {}, "A drive under way"),
      field("Telemetry so far as CSV", telemetry, "What the drive has met tells of the ground ahead: the check then begins where the rover is now, and shows what was measured against what had been predicted."),
      field("or its file", telemetryFile)),
    h("h2", {}, "Zones"),
    toolBar(["keep_out", "keep_in"]),
    zones(),
    fault,
    button("Check the drive", check, { class: "primary", "data-do": "check" }),
    curl,
  );
}
