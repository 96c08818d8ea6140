// Drives and maps that are sent to the service.
import { ask, get, ServiceError, type Job } from "../api/client";
import { button, field, fill, h, select } from "../dom";
import { loading, problemView } from "../problem";
import { store } from "../state";
import { start } from "../work";

/** Whether the service takes files, as its operator has set it. */
export async function takesUploads(): Promise<boolean> {
  try {
    await get("v1/uploads");
    return true;
  } catch (error) {
    if (error instanceof ServiceError && error.status === 404) return false;
    throw error;
  }
}

/** A file's name as the service takes it. */
export const plainName = (name: string): string => name.replace(/[^A-Za-z0-9._-]/g, "_").replace(/^[._]+/, "").slice(-100) || "file";

async function send(file: File): Promise<string> {
  const response = await ask(`v1/uploads?name=${encodeURIComponent(plainName(file.name))}`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file });
  return ((await response.json()) as { id: string }).id;
}

/** Sends files, then asks for what is to be made of them. */
async function sendAll(note: HTMLElement, files: Record<string, File | undefined>, then: (ids: Record<string, string>) => Promise<void>): Promise<void> {
  fill(note, loading("Sending"));
  try {
    const ids: Record<string, string> = {};
    for (const [key, file] of Object.entries(files)) if (file) ids[key] = await send(file);
    fill(note);
    await then(ids);
  } catch (error) {
    fill(note, problemView(error));
  }
}

export function campaignUpload(target: HTMLElement, taken: (name: string) => void): void {
  const note = h("div");
  const file = h("input", { type: "file", accept: ".tar,.tgz,.gz,.zip", "data-upload": "campaign" });
  const press = button("Send the drives", () => {
    const archive = file.files?.[0];
    if (!archive) {
      fill(note, problemView("Choose an archive first."));
      return;
    }
    void sendAll(note, { archive }, (ids) => start("v1/drive-campaigns", { upload: ids.archive! }));
  });
  whenDone("drive_campaign", (answer) => taken((answer as { name: string }).name));
  fill(target, h("details", {}, h("summary", {}, "Send drives of your own"), field("Archive (tar, tar.gz or zip)", file, "It holds campaign.json and the files that this names; every fault of every file is told."), press, note));
}

export function terrainUpload(opened: (name: string) => void): { open: () => void } {
  const note = h("div");
  const text = (attributes: Record<string, string | boolean> = {}) => h("input", { autocomplete: "off", ...attributes });
  const name = text({ required: true, pattern: "[a-z0-9_\\-]+", "data-upload": "name" });
  const elevation = h("input", { type: "file", accept: ".tif,.tiff,.img,.asc,.vrt,.lbl", required: true, "data-upload": "elevation" });
  const soil = h("input", { type: "file", accept: ".tif,.tiff,.geojson,.json", "data-upload": "soil" });
  const legend = h("input", { type: "file", accept: ".csv", "data-upload": "legend" });
  const property = text({ value: "unit", "data-upload": "property" });
  let coordinates: "lonlat" | "map" = "lonlat";
  const ofPolygons = h("div", { class: "columns" },
    field("Property that names the class", property, "Of each polygon: what the legend's labels are."),
    field("Places of the polygons", select([{ value: "lonlat", text: "degrees, longitude and latitude" }, { value: "map", text: "metres of the map" }], "lonlat", (value) => (coordinates = value as typeof coordinates))));
  ofPolygons.hidden = true;
  const arePolygons = () => /\.(geo)?json$/i.test(soil.files?.[0]?.name ?? "");
  soil.addEventListener("change", () => (ofPolygons.hidden = !arePolygons()));
  const [title, licence, source] = [text(), text(), text()];
  const fix = h("input", { type: "checkbox" });
  const dialog = h(
    "dialog",
    { "aria-labelledby": "terrain-title" },
    h("form", { onsubmit: (event) => {
      event.preventDefault();
      void sendAll(note, { elevation: elevation.files?.[0], soil: soil.files?.[0], legend: legend.files?.[0] }, async (ids) => {
        const said = Object.fromEntries(Object.entries({ title, licence, source }).map(([key, input]) => [key, input.value.trim()]).filter(([, value]) => value));
        dialog.close();
        const polygons = arePolygons() ? { property: property.value.trim() || "unit", soil_coordinates: coordinates } : {};
        await start("v1/terrains", { name: name.value, elevation: ids.elevation!, ...ids, ...polygons, ...said, ...(fix.checked ? { fix: true } : {}) });
      });
    } },
      h("h2", { id: "terrain-title" }, "A terrain of your own"),
      field("Name", name, "Small letters, digits, - and _"),
      field("Elevation map", elevation, "In a metric projection of its body; what is wrong with it is told, with the command that converts it."),
      h("div", { class: "columns" }, field("Map of soil classes (optional)", soil), field("Its legend (optional CSV)", legend, "value, label, soil")),
      ofPolygons,
      field("Title", title),
      h("div", { class: "columns" }, field("Licence", licence), field("Source", source)),
      h("label", {}, fix, " mend what can be mended without a guess"),
      note,
      h("div", { class: "row" }, h("button", { class: "primary" }, "Send"), button("Cancel", () => dialog.close(), { class: "quiet" }))),
  );
  document.body.append(dialog);
  whenDone("terrain", (answer) => opened((answer as { name: string }).name));
  return { open: () => dialog.showModal() };
}

/** Once for each job of this kind that ends well while it is followed. */
function whenDone(kind: string, run: (answer: unknown) => void): void {
  let seen = "";
  store.on(["job"], ({ job }) => {
    const done = job as (Job & { kind: string }) | null;
    if (done?.kind !== kind || done.state !== "successful" || done.id === seen) return;
    seen = done.id!;
    get(`v1/jobs/${seen}/result`).then(run, (error) => store.set({ error }));
  });
}
