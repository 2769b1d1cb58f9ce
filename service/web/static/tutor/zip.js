// Reads ZIP archives that the service has written.

const END = 0x06054b50;
const END_SIZE = 22;

/**
 * Return the entries of an archive by their names.
 *
 * @param {ArrayBuffer} buffer
 * @returns {Map<string, Front.ZipEntry>}
 */
export function entries(buffer) {
  const view = new DataView(buffer);
  const end = buffer.byteLength - END_SIZE;
  if (end < 0 || view.getUint32(end, true) !== END) throw new Error("The answer is no ZIP archive.");
  const found = new Map();
  let at = view.getUint32(end + 16, true);
  for (let i = view.getUint16(end + 10, true); i > 0; i -= 1) {
    const [nameLength, extra, comment] = [28, 30, 32].map((offset) => view.getUint16(at + offset, true));
    const name = new TextDecoder().decode(new Uint8Array(buffer, at + 46, nameLength));
    const local = view.getUint32(at + 42, true);
    // The extra field of the local header may have another length.
    const from = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
    found.set(name, { from, size: view.getUint32(at + 20, true), packed: view.getUint16(at + 10, true) !== 0 });
    at += 46 + nameLength + extra + comment;
  }
  return found;
}

/**
 * Return the text of an entry.
 *
 * @param {ArrayBuffer} buffer
 * @param {Front.ZipEntry} entry
 */
export function textOf(buffer, { from, size, packed }) {
  const bytes = new Blob([new Uint8Array(buffer, from, size)]);
  if (!packed) return bytes.text();
  return new Response(bytes.stream().pipeThrough(new DecompressionStream("deflate-raw"))).text();
}
