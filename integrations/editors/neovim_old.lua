-- Neovim 0.7 to 0.10: put this into init.lua.
vim.api.nvim_create_autocmd({ "BufRead", "BufNewFile" }, {
  pattern = { "*.vert", "*.frag", "*.geom", "*.vs", "*.fs", "*.gs", "*.vsh", "*.fsh", "*.gsh", "*.glslv", "*.glslf", "*.glsl" },
  callback = function()
    vim.bo.filetype = "glsl"
  end,
})
-- Other languages have shaders in their strings: add "javascript", "typescript", "rust", "python", "c", "cpp" for those.
local languages = { "glsl" }
local clients = {}

-- The folder of the nearest configuration or repository.
local function root(name)
  local folder = vim.fn.fnamemodify(name, ":p:h")
  local configuration = vim.fn.findfile("glisten.toml", folder .. ";")
  local repository = vim.fn.finddir(".git", folder .. ";")
  local found = configuration ~= "" and configuration or repository
  return found ~= "" and vim.fn.fnamemodify(found, ":p"):gsub("/$", ""):match("^(.*)/") or folder
end

vim.api.nvim_create_autocmd("FileType", {
  pattern = languages,
  callback = function(event)
    local folder = root(vim.api.nvim_buf_get_name(event.buf))
    clients[folder] = clients[folder]
      or vim.lsp.start_client({
        name = "glisten",
        cmd = { "glisten", "lsp" },
        root_dir = folder,
        on_exit = function()
          clients[folder] = nil
        end,
      })
    vim.lsp.buf_attach_client(event.buf, clients[folder])
  end,
})
