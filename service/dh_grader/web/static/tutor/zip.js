// Reads ZIP archives from the service and from learning platforms, and writes archives with some of the entries.

const END = 0x06054b50;
const FILE = 0x02014b50;
const END_SIZE = 22;
const LONGEST_COMMENT = 0xffff;
const ENCRYPTED = 1;
const IN_UTF_8 = 0x800;
const STORED = 0;
const DEFLATED = 8;

/**
 * Return the entries of an archive by their names, without folders. Throws an Error if the archive is damaged.
 *
 * @param {ArrayBuffer} buffer
 * @returns {Map<string, Front.ZipEntry>}
 */
export function entries(buffer) {
  const view = new DataView(buffer);
  const end = endOf(view);
  const found = new Map();
  let at = view.getUint32(end + 16, true);
  for (let i = view.getUint16(end + 10, true); i > 0; i -= 1) {
    if (at + 46 > end || view.getUint32(at, true) !== FILE) throw new Error("The ZIP archive is damaged.");
    const [flags, method] = [8, 10].map((offset) => view.getUint16(at + offset, true));
    const [nameLength, extra, comment] = [28, 30, 32].map((offset) => view.getUint16(at + offset, true));
    const next = at + 46 + nameLength + extra + comment;
    const [size, local] = [20, 42].map((offset) => view.getUint32(at + offset, true));
    // The extra field in the local header may differ in length from that in the directory.
    const from = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
    if (next > end || from + size > end) throw new Error("The ZIP archive is damaged.");
    const name = text(new Uint8Array(buffer, at + 46, nameLength), (flags & IN_UTF_8) !== 0);
    const isReadable = !(flags & ENCRYPTED) && (method === STORED || method === DEFLATED);
    if (!name.endsWith("/")) {
      found.set(name, { from, size, packed: method !== STORED, isReadable, local, head: at, headEnd: next });
    }
    at = next;
  }
  return found;
}

/**
 * Return the place of the last record, which may be followed by a comment.
 *
 * @param {DataView} view
 */
function endOf(view) {
  const last = view.byteLength - END_SIZE;
  for (let at = last; at >= Math.max(0, last - LONGEST_COMMENT); at -= 1) {
    if (view.getUint32(at, true) === END && at + END_SIZE + view.getUint16(at + 20, true) === view.byteLength) {
      return at;
    }
  }
  throw new Error("This is no ZIP archive.");
}

/** @param {Uint8Array} name @param {boolean} isUtf8 */
function text(name, isUtf8) {
  try {
    return new TextDecoder("utf-8", { fatal: !isUtf8 }).decode(name);
  } catch {
    return new TextDecoder("latin1").decode(name);
  }
}

/**
 * Return the bytes of an entry, or null if there are more than `most`. Unpacking stops after `most` bytes.
 *
 * @param {ArrayBuffer} buffer
 * @param {Front.ZipEntry} entry
 * @param {number} [most]
 * @returns {Promise<Uint8Array<ArrayBuffer> | null>}
 */
export async function bytesOf(buffer, { from, size, packed }, most = Infinity) {
  const bytes = new Uint8Array(buffer, from, size);
  if (!packed) return size > most ? null : bytes;
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const pieces = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(pieces).arrayBuffer());
    length += value.length;
    if (length > most) {
      await reader.cancel();
      return null;
    }
    pieces.push(value);
  }
}

/**
 * Return the text of an entry.
 *
 * @param {ArrayBuffer} buffer
 * @param {Front.ZipEntry} entry
 */
export async function textOf(buffer, entry) {
  return new TextDecoder().decode(await bytesOf(buffer, entry) ?? new Uint8Array());
}

/**
 * Return an archive with some of the entries.
 *
 * @param {ArrayBuffer} buffer
 * @param {Front.ZipEntry[]} chosen
 */
export function archiveOf(buffer, chosen) {
  let at = 0;
  const heads = chosen.map(({ from, size, local, head, headEnd }) => {
    const copy = buffer.slice(head, headEnd);
    new DataView(copy).setUint32(42, at, true);
    at += from + size - local;
    return copy;
  });
  const end = new DataView(new ArrayBuffer(END_SIZE));
  end.setUint32(0, END, true);
  for (const offset of [8, 10]) end.setUint16(offset, chosen.length, true);
  end.setUint32(12, heads.reduce((length, head) => length + head.byteLength, 0), true);
  end.setUint32(16, at, true);
  const files = chosen.map(({ from, size, local }) => new Uint8Array(buffer, local, from + size - local));
  return new Blob([...files, ...heads, end.buffer], { type: "application/zip" });
}
