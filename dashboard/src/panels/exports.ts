// What can be taken along: files for a GIS or a table, and a page of paper.
import { address, token } from "../api/client";
import { button, h } from "../dom";
import type { Result } from "../result";
import { store } from "../state";
import { keep, keepStations } from "../work";

export function exportsView(result: Result, print: () => void): HTMLElement {
  const at = `v1/jobs/${result.job}`;
  const report = `${at}/report`;
  const file = (label: string, run: () => void, title: string) => button(label, run, { class: "quiet", title, "data-export": label });
  return h("div", { class: "exports" },
    h("h3", {}, "Take along"),
    h("div", { class: "row wrap" },
      button("Print a page", print, { "data-do": "print", title: "One page for the meeting, legible in black and white" }),
      result.kind === "check" && (token() ? button("Report", () => void keep(report, "check.html"), { class: "quiet" }) : h("a", { href: address(report), target: "_blank", rel: "noopener" }, "Report for the meeting")),
      file("GeoPackage", () => void keep(`${at}/vectors.gpkg`, `${result.kind}.gpkg`), "Routes, stations, rules and checks with their styles, for QGIS"),
      file("GeoJSON", () => void keep(`${at}/vectors.geojson`, `${result.kind}.geojson`), "The same in metres of the map"),
      file("GeoJSON, degrees", () => void keep(`${at}/vectors.geojson?coordinates=lonlat`, `${result.kind}_lonlat.geojson`), "The same in longitude and latitude of the body"),
      file("CSV", () => void keepStations(result.job, `${result.kind}.csv`), "All stations as a table"),
      file("JSON", () => void keep(`${at}/result`, `${result.kind}.json`), "The whole answer"),
      result.kind !== "prediction" && file("Picture", () => void keep(`${at}/map`, `${result.kind}.svg`), "The routes on the relief as SVG")),
    h("div", { class: "row wrap" },
      button("Keep for comparison", () => store.set({ other: result }), { class: "quiet", "data-do": "keep" }),
      store.state.other && button("Forget the kept one", () => store.set({ other: null }), { class: "quiet" })));
}
