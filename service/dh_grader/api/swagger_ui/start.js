// Draws the operations of the page /docs. Without a validator: that would be a request to another host.
const root = document.documentElement;
const place = document.getElementById("interface");
const prefersDark = matchMedia("(prefers-color-scheme: dark)");

// Swagger UI has dark colours for a root element of this class.
function showTheme() {
  const { theme } = root.dataset;
  root.classList.toggle("dark-mode", theme ? theme === "dark" : prefersDark.matches);
}

// The page has a heading and a main element of its own, so only these components are drawn.
function layout({ React: { createElement: h } }) {
  const Reference = ({ getComponent }) =>
    h(
      "div",
      { className: "swagger-ui" },
      h(getComponent("SvgAssets")),
      h(getComponent("errors", true)),
      h("div", { className: "auth-wrapper" }, h(getComponent("AuthorizeBtnContainer", true))),
      h("h2", {}, "Operations"),
      h(getComponent("operations", true)),
      h(getComponent("Models", true)),
    );
  return { components: { Reference } };
}

// Attributes that Swagger UI leaves out, and that people with a keyboard or a screen reader need.
const ATTRIBUTES = [
  ["textarea.body-param__text:not([aria-label])", "aria-label", "Request body"],
  // Of the many regions of the page, none would be distinct.
  ["table.responses-table:not([role=table])", "role", "table"],
  ["pre.microlight:not([tabindex])", "tabindex", "0"],
  ["pre.microlight:not([role])", "role", "group"],
  ["pre.microlight:not([aria-label])", "aria-label", "JSON"],
];

function complete() {
  for (const [selector, name, value] of ATTRIBUTES) {
    for (const element of place.querySelectorAll(selector)) element.setAttribute(name, value);
  }
}

prefersDark.addEventListener("change", showTheme);
new MutationObserver(showTheme).observe(root, { attributeFilter: ["data-theme"] });
showTheme();
new MutationObserver(complete).observe(place, { childList: true, subtree: true });
SwaggerUIBundle({
  url: "openapi.json",
  domNode: place,
  // Without the links inside the buttons of operations.
  deepLinking: false,
  layout: "Reference",
  plugins: [layout],
  validatorUrl: null,
  tryItOutEnabled: true,
});
