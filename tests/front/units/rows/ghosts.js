// Reads rows from the standard input, as JSON: each row has a frame, numbers, a convention, and places between 0
// and 4. Writes the ghost frame at each place.

import { frameAt, movesOf } from "../../../../service/dh_grader/web/static/robot/rows/row_moves.js";

const rows = JSON.parse(await new Response(Deno.stdin.readable).text());
const ghosts = rows.map(({ frame, values, convention, places }) => {
  const moves = movesOf(values, convention);
  return places.map((at) => frameAt(frame, moves, at));
});
console.log(JSON.stringify(ghosts));
