-- Neovim 0.8 to 0.10: put this into init.lua.
for _, extension in ipairs({ "vert", "frag", "geom", "vs", "fs", "gs", "vsh", "fsh", "glsl" }) do
  vim.filetype.add({ extension = { [extension] = "glsl" } })
end
vim.api.nvim_create_autocmd("FileType", {
  pattern = "glsl",
  callback = function(event)
    local found = vim.fs.find({ "glisten.toml", ".git" }, { upward = true, path = vim.api.nvim_buf_get_name(event.buf) })[1]
    vim.lsp.start({
      name = "glisten",
      cmd = { "glisten", "lsp" },
      root_dir = found and vim.fs.dirname(found) or vim.fs.dirname(vim.api.nvim_buf_get_name(event.buf)),
    })
  end,
})
