import glisten from "glisten/vite";

export default { plugins: [glisten()] };
