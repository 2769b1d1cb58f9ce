// The page of free play.

import { DhPlay } from "./play_element.js";

if (!customElements.get("dh-play")) customElements.define("dh-play", DhPlay);
