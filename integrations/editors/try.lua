-- Runs in Neovim with the setup for glisten: asks for everything, and ends it.
local function fail(what)
  io.stderr:write("glisten: " .. what .. "\n")
  vim.cmd("cquit 1")
end

local function check(is_so, what)
  if not is_so then
    fail(what)
  end
end

local function at(word)
  for number, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    local column = line:find(word, 1, true)
    if column then
      vim.api.nvim_win_set_cursor(0, { number, column - 1 })
      return
    end
  end
  fail("there is no " .. word)
end

local function ask(method, more)
  local params = vim.tbl_extend("force", vim.lsp.util.make_position_params(0, "utf-16"), more or {})
  local answers = vim.lsp.buf_request_sync(0, method, params, 10000) or {}
  for _, answer in pairs(answers) do
    check(not answer.err, method .. ": " .. vim.inspect(answer.err))
    return answer.result
  end
  fail(method .. ": no answer")
end

local function wait(what, is_so)
  check(vim.wait(10000, is_so, 50), what)
end

wait("the server starts", function()
  return #vim.lsp.buf_get_clients(0) > 0
end)
at("light(position")
wait("definition", function()
  local found = ask("textDocument/definition")
  found = found and (found[1] or found)
  return found and (found.uri or ""):match("light%.glsl$") ~= nil
end)
check(vim.inspect(ask("textDocument/hover")):find("A light", 1, true), "hover: the comment")
check(#ask("textDocument/references", { context = { includeDeclaration = true } }) == 2, "references")
at("shade =")
local renamed = vim.inspect(ask("textDocument/rename", { newName = "tint" }))
check(renamed:find("a.frag", 1, true) and renamed:find("a.vert", 1, true), "rename over both stages: " .. renamed)
check(#ask("textDocument/documentSymbol") > 0, "symbols")
check(#(ask("textDocument/completion").items or {}) > 20, "completion")

vim.cmd("edit a.frag")
wait("the finding of both stages", function()
  for _, one in ipairs(vim.diagnostic.get(0)) do
    if one.code == "E0703" or (one.user_data and vim.inspect(one.user_data):find("E0703", 1, true)) then
      return true
    end
  end
end)
local edits = ask("textDocument/formatting", { options = { tabSize = 4, insertSpaces = true } })
vim.lsp.util.apply_text_edits(edits, 0, "utf-16")
local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), "\n")
check(text:find("void main() { color = shade; }", 1, true), "formatting: " .. text)
vim.api.nvim_buf_set_lines(0, 1, 2, false, { "in vec3 shade;" })
wait("the finding after an edit", function()
  for _, one in ipairs(vim.diagnostic.get(0)) do
    if one.lnum == 3 and one.severity == vim.diagnostic.severity.ERROR then
      return true
    end
  end
end)
io.stderr:write("glisten: all done\n")
vim.cmd("qall!")
