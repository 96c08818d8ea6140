// A map of risk as the page keeps it.
import type { MapDocument } from "../api/client";
import type { Raster } from "./tiff";

export type RiskKind = "slip_best" | "slip_worst" | "slip" | "stop_risk" | "embedding_risk" | "verdict" | "cost_to_go" | "reachable";

export interface RiskMap {
  kind: RiskKind;
  job: string;
  opacity: number;
  request: string; // as JSON, to know whether it is still what would be asked for
  progress: number | null; // null: it is there
  document: MapDocument | null;
  raster: Raster | null;
}
