// What a page asks the service at its start, all at once.
import { get, type CostTerm, type Effect, type Rover, type RuleSet, type Terrain, type TerrainDocument } from "./client";

export interface First {
  terrain: Promise<TerrainDocument> | null; // of the link, if it names one
  lists: Promise<[{ terrains: Terrain[] }, { rovers: Rover[] }, { rules: RuleSet[] }, { cost_terms: CostTerm[] }, { effects: Effect[] }]>;
}

let asked: First | null = null;

export function askFirst(terrain: string): First {
  const first: First = {
    terrain: terrain ? get<TerrainDocument>(terrainAddress(terrain)) : null,
    lists: Promise.all([
      get<{ terrains: Terrain[] }>("v1/terrains"),
      get<{ rovers: Rover[] }>("v1/rovers"),
      get<{ rules: RuleSet[] }>("v1/rules"),
      get<{ cost_terms: CostTerm[] }>("v1/planners"),
      get<{ effects: Effect[] }>("v1/effects"),
    ]),
  };
  // Who takes them hears what went wrong.
  first.terrain?.catch(() => undefined);
  first.lists.catch(() => undefined);
  asked = first;
  return first;
}

/** What was asked for before the program was there; asked for now where that has been taken. */
export function takeFirst(terrain: string): First {
  const first = asked ?? askFirst(terrain);
  asked = null;
  return first;
}

export const terrainAddress = (name: string): string => `v1/terrains/${encodeURIComponent(name)}`;
