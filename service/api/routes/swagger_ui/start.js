// Draws the page /docs. Without a validator: that would be a request to another host.
SwaggerUIBundle({
  url: "openapi.json",
  dom_id: "#interface",
  deepLinking: true,
  validatorUrl: null,
  tryItOutEnabled: true,
});
