// The page's first script: asks for what every page begins with while the rest of the program is still on its way.
import "ol/ol.css";
import "uplot/dist/uPlot.min.css";
import "./styles/page.css";
import { askFirst } from "./api/first";

void import("./main"); // before the questions: a browser has six connections
askFirst(new URLSearchParams(location.hash.slice(1)).get("terrain") ?? "");
