// Room that what is brought into sight keeps free at each side of the map, so that no mark lies under a control.

interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Padding at top, right, bottom, left: low controls take it from above or below, high ones from the left or the right. */
export function clearOf(map: Box, controls: Box[], px: number): number[] {
  const [width, height] = [map.right - map.left, map.bottom - map.top];
  const padding = [px, px, px, px];
  for (const box of controls) {
    if (box.right <= map.left || box.left >= map.right || box.bottom <= map.top || box.top >= map.bottom) continue;
    const cuts = [box.bottom - map.top, map.right - box.left, map.bottom - box.top, box.right - map.left];
    const sides = box.bottom - box.top < height / 4 ? [0, 2] : [1, 3];
    const side = cuts[sides[0]!]! < cuts[sides[1]!]! ? sides[0]! : sides[1]!;
    padding[side] = Math.max(padding[side]!, cuts[side]! + px);
  }
  // What is left must be seen: a map that its controls nearly fill keeps a third.
  for (const [a, b, size] of [[0, 2, height], [3, 1, width]] as const) {
    const sum = padding[a]! + padding[b]!;
    const most = (2 * size) / 3;
    if (sum > most) for (const side of [a, b]) padding[side] = (padding[side]! * most) / sum;
  }
  return padding;
}
