// Tell the platform that the registration is over, so that it closes this page (1EdTech, LTI Dynamic Registration).

document.getElementById("close")?.addEventListener("click", () => {
  const platform = opener ?? parent;
  // The platform's page may be on any host. Every page may read the message, because the message has no content.
  platform.postMessage({ subject: "org.imsglobal.lti.close" }, "*");
});
