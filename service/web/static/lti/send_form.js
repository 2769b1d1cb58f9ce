// Send the form that takes the tutor back to the platform. Without scripts, its button does.

const form = document.getElementById("send");
if (form instanceof HTMLFormElement) form.submit();
