// The colours of the 3D view, light and dark; they are those of the figures.

/** The light colours; the dark ones have the same names. */
export const LIGHT = {
  rod: 0xc3cad4,
  turning: 0x7fb0e6,
  sliding: 0xefc877,
  ground: 0xdfe3e9,
  grip: 0x98a2b0,
  axis: 0x7b8696,
  chain: 0x8e44ad,
  ink: "#1c2430",
  paper: "#ffffff",
  x: 0xc62828,
  y: 0x1f7a34,
  z: 0x1d4fc4,
  xPale: 0xe59a9a,
  yPale: 0x93c7a1,
  zPale: 0x9db4ec,
  gap: 0xd97706,
  quiet: "#5d6877",
};
const DARK = {
  rod: 0x5b6678,
  turning: 0x4f8ccc,
  sliding: 0xc99a44,
  ground: 0x2b3340,
  grip: 0x7c8798,
  axis: 0x8b97a8,
  chain: 0xd19cf0,
  ink: "#e8ecf2",
  paper: "#12161d",
  x: 0xff8080,
  y: 0x6fd68a,
  z: 0x8ab4ff,
  xPale: 0x96545a,
  yPale: 0x467d57,
  zPale: 0x5470a8,
  gap: 0xfbbf24,
  quiet: "#a7b2c2",
};

/**
 * Return true if an element has light text, so that its background is dark.
 *
 * @param {Element} element
 */
export function isDark(element) {
  const [red, green, blue] = (getComputedStyle(element).color.match(/[\d.]+/g) ?? ["0", "0", "0"]).map(Number);
  return red + green + blue > 384;
}

/**
 * Return the palette that suits an element: dark if its text is light.
 *
 * @param {Element} element
 * @returns {Front.Palette}
 */
export const paletteOf = (element) => (isDark(element) ? DARK : LIGHT);
