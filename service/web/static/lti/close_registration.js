// Tell the platform that its registration is over: it closes this page (1EdTech, LTI Dynamic Registration).

document.getElementById("close")?.addEventListener("click", () => {
  const platform = opener ?? parent;
  // The message has no content, so any page may read it: the platform's page may have a host of its own.
  platform.postMessage({ subject: "org.imsglobal.lti.close" }, "*");
});
