// Types of imports that the Vite plugin answers: `/// <reference types="glisten/client" />`.
declare module "*?glisten" {
  const program: import("glisten/vite").ImportedProgram;
  export default program;
}
