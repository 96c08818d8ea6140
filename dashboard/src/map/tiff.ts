// Reads the rasters that the service writes: one band of bytes or floats in deflated tiles, a cloud-optimised GeoTIFF.

export interface Raster {
  columns: number;
  rows: number;
  values: Float32Array | Uint8Array;
}

const tags = { columns: 256, rows: 257, bits: 258, compression: 259, predictor: 317, tileColumns: 322, tileRows: 323, offsets: 324, counts: 325 };
const bytesOfType: Record<number, number> = { 1: 1, 3: 2, 4: 4 };

/** Throws an Error where the file is none of those. The page stays usable meanwhile: each tile is a piece of work of its own. */
export async function readTiff(bytes: ArrayBuffer, nodata: number): Promise<Raster> {
  const view = new DataView(bytes);
  if (view.getUint16(0) !== 0x4949 || view.getUint16(2, true) !== 42) throw new Error("This is no TIFF as the service writes them.");
  const fields = readFields(view);
  const one = (tag: number, otherwise: number): number => fields.get(tag)?.[0] ?? otherwise;
  const [columns, rows, bits, predictor] = [one(tags.columns, 0), one(tags.rows, 0), one(tags.bits, 8), one(tags.predictor, 1)];
  const [tileColumns, tileRows] = [one(tags.tileColumns, 0), one(tags.tileRows, 0)];
  if (![8, 32946].includes(one(tags.compression, 1)) || ![8, 32].includes(bits) || tileColumns === 0 || (bits === 32 && predictor === 2)) throw new Error("This TIFF is packed in a way that the page does not read.");
  const values = bits === 8 ? new Uint8Array(columns * rows) : new Float32Array(columns * rows);
  values.fill(nodata);
  const across = Math.ceil(columns / tileColumns);
  const offsets = fields.get(tags.offsets)!;
  for (let k = 0; k < offsets.length; ++k) {
    if (fields.get(tags.counts)![k] === 0) continue; // nothing but nodata
    const packed = new Uint8Array(bytes, offsets[k]!, fields.get(tags.counts)![k]!);
    const tile = await inflated(packed);
    const rowBytes = (tileColumns * bits) / 8;
    const first = { column: (k % across) * tileColumns, row: Math.floor(k / across) * tileRows };
    const width = Math.min(tileColumns, columns - first.column);
    for (let r = 0; r < Math.min(tileRows, rows - first.row); ++r) {
      const row = tile.subarray(r * rowBytes, (r + 1) * rowBytes);
      if (predictor !== 1) summed(row);
      const at = (first.row + r) * columns + first.column;
      if (bits === 8) (values as Uint8Array).set(row.subarray(0, width), at);
      else (values as Float32Array).set(floats(row, tileColumns, predictor === 3).subarray(0, width), at);
    }
  }
  return { columns, rows, values };
}

/** The first of the file's pictures: those behind it are the same from farther away. */
function readFields(view: DataView): Map<number, number[]> {
  const fields = new Map<number, number[]>();
  const start = view.getUint32(4, true);
  for (let i = 0; i < view.getUint16(start, true); ++i) {
    const at = start + 2 + 12 * i;
    const [type, count] = [view.getUint16(at + 2, true), view.getUint32(at + 4, true)];
    const size = bytesOfType[type];
    if (!size) continue;
    const from = size * count <= 4 ? at + 8 : view.getUint32(at + 8, true);
    const read = (k: number) => (size === 1 ? view.getUint8(from + k) : size === 2 ? view.getUint16(from + 2 * k, true) : view.getUint32(from + 4 * k, true));
    fields.set(view.getUint16(at, true), Array.from({ length: count }, (_, k) => read(k)));
  }
  return fields;
}

async function inflated(packed: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Undoes the predictors' differences, byte by byte: both that the service writes have them. */
function summed(row: Uint8Array): void {
  for (let i = 1; i < row.length; ++i) row[i] = row[i]! + row[i - 1]!;
}

/** With the floating-point predictor, all highest bytes stand before all second ones [TIFF Technical Note 3]. */
function floats(row: Uint8Array, count: number, in_planes: boolean): Float32Array {
  const bytes = new Uint8Array(4 * count);
  if (in_planes) for (let plane = 0; plane < 4; ++plane) for (let i = 0; i < count; ++i) bytes[4 * i + 3 - plane] = row[plane * count + i]!;
  else bytes.set(row);
  return new Float32Array(bytes.buffer);
}
