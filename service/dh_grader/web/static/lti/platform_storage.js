// The platform's storage: if cookies are blocked, it holds the secret of a login
// (1EdTech, LTI Client Side postMessages and Platform Storage).

const WAIT = 4000;
const place = document.getElementById("platform-storage");
if (place) (place.dataset.does === "put" ? put : get)(place);

/** Put the secret into the storage; go on to the platform, even if the storage fails. @param {HTMLElement} place */
async function put(place) {
  const { name: key = "", value = "", address = "" } = place.dataset;
  await ask(place, { subject: "lti.put_data", key, value });
  location.replace(address);
}

/** Read the secret and send the message again with it; without a secret, offer a window. @param {HTMLElement} place */
async function get(place) {
  const found = await ask(place, { subject: "lti.get_data", key: place.dataset.name ?? "" });
  if (place instanceof HTMLFormElement && typeof found === "string" && found) {
    const field = place.elements.namedItem("browser");
    if (field instanceof HTMLInputElement) field.value = found;
    place.submit();
    return;
  }
  place.remove();
  document.getElementById("own-window")?.removeAttribute("hidden");
}

/**
 * Return the value in the platform's answer to a message, or null if there is no answer.
 *
 * @param {HTMLElement} place
 * @param {{ subject: string, key: string, value?: string }} message
 * @returns {Promise<unknown>}
 */
function ask(place, message) {
  const { frame = "", origin = "" } = place.dataset;
  const platform = storageFrame(frame);
  const id = crypto.randomUUID();
  return new Promise((resolve) => {
    /** @param {unknown} value */
    const end = (value) => {
      removeEventListener("message", heard);
      clearTimeout(timer);
      resolve(value);
    };
    /** @param {MessageEvent} event */
    const heard = ({ data, origin: from, source }) => {
      const isAnswer = from === origin && source === platform && data?.message_id === id &&
        data.subject === `${message.subject}.response`;
      if (isAnswer) end(data.error || data.key !== message.key ? null : data.value);
    };
    const timer = setTimeout(() => end(null), platform ? WAIT : 0);
    addEventListener("message", heard);
    platform?.postMessage({ ...message, message_id: id }, origin);
  });
}

/**
 * Return the window with the platform's storage: the platform's page, or a frame in that page.
 *
 * @param {string} name
 * @returns {Window | null}
 */
function storageFrame(name) {
  const page = parent === window ? opener : parent;
  if (!page || name === "_parent") return page;
  try {
    return page.frames[name] ?? page;
  } catch {
    return page;
  }
}
