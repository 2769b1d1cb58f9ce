// The attributes of <dh-exercise> that may change at any time.
export const ATTRIBUTES = [
  "exercise",
  "api",
  "parts",
  "practice",
  "readonly",
  "theme",
  "assignment",
  "submit",
  "token",
];
