-- Neovim 0.11 or later: put this into init.lua.
vim.lsp.config("glisten", {
  cmd = { "glisten", "lsp" },
  filetypes = { "glsl" },
  root_markers = { "glisten.toml", ".git" },
})
vim.lsp.enable("glisten")
vim.filetype.add({
  extension = { vert = "glsl", frag = "glsl", geom = "glsl", vs = "glsl", fs = "glsl", gs = "glsl", vsh = "glsl", fsh = "glsl", gsh = "glsl", glslv = "glsl", glslf = "glsl", glsl = "glsl" },
})
