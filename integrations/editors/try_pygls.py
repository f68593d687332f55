"""Runs in the folder of a program: a client of pygls goes through the requests of `glisten lsp`."""

import asyncio
import pathlib

from lsprotocol import types as t
from pygls.lsp.client import LanguageClient


async def main():
    root = pathlib.Path.cwd()
    client = LanguageClient("try", "1")
    told = {}
    changed = asyncio.Event()

    @client.feature(t.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    def _(params):
        told[params.uri] = params.diagnostics
        changed.set()

    await client.start_io("glisten", "lsp")
    answer = await client.initialize_async(t.InitializeParams(capabilities=t.ClientCapabilities(), root_uri=root.as_uri()))
    assert answer.server_info.name == "glisten"
    client.initialized(t.InitializedParams())
    texts = {name: (root / name).read_text() for name in ("a.vert", "a.frag")}
    uris = {name: (root / name).as_uri() for name in texts}
    for name, text in texts.items():
        client.text_document_did_open(t.DidOpenTextDocumentParams(t.TextDocumentItem(uris[name], "glsl", 1, text)))

    def place(name, word):
        before = texts[name][: texts[name].index(word)]
        line = before.split("\n")[-1]
        position = t.Position(before.count("\n"), len(line.encode("utf-16-le")) // 2)
        return {"text_document": t.TextDocumentIdentifier(uris[name]), "position": position}

    while not any(one.code == "E0703" for one in told.get(uris["a.frag"], [])):
        changed.clear()
        await asyncio.wait_for(changed.wait(), 20)
    n_asked = 0

    async def ask(request, params, holds):
        nonlocal n_asked
        answer = await asyncio.wait_for(request(params), 20)
        assert holds(answer), answer
        n_asked += 1
        return answer

    c = client
    on = place("a.vert", "light(position")
    doc = {"text_document": t.TextDocumentIdentifier(uris["a.vert"])}
    whole = t.Range(t.Position(0, 0), t.Position(99, 0))
    context = t.ReferenceContext(include_declaration=True)
    await ask(c.text_document_hover_async, t.HoverParams(**on), lambda a: "A light" in a.contents.value)
    await ask(c.text_document_definition_async, t.DefinitionParams(**on), lambda a: a.uri.endswith("light.glsl"))
    await ask(c.text_document_references_async, t.ReferenceParams(context=context, **on), lambda a: len(a) == 2)
    await ask(c.text_document_completion_async, t.CompletionParams(**on), lambda a: len(a.items) > 20)
    shade = place("a.vert", "shade =")
    await ask(c.text_document_prepare_rename_async, t.PrepareRenameParams(**shade), lambda a: a.placeholder == "shade")
    await ask(c.text_document_rename_async, t.RenameParams(new_name="tint", **shade), lambda a: len(a.changes) == 2)
    await ask(c.text_document_document_highlight_async, t.DocumentHighlightParams(**shade), lambda a: len(a) == 2)
    await ask(c.text_document_signature_help_async, t.SignatureHelpParams(**place("a.vert", "position.x")), lambda a: a.signatures)
    await ask(c.text_document_document_symbol_async, t.DocumentSymbolParams(**doc), lambda a: a)
    await ask(c.workspace_symbol_async, t.WorkspaceSymbolParams(query="lgt"), lambda a: a)
    await ask(c.text_document_semantic_tokens_full_async, t.SemanticTokensParams(**doc), lambda a: len(a.data) > 50)
    await ask(c.text_document_folding_range_async, t.FoldingRangeParams(**doc), lambda a: a is not None)
    await ask(c.text_document_selection_range_async, t.SelectionRangeParams(positions=[on["position"]], **doc), lambda a: a[0].parent)
    await ask(c.text_document_inlay_hint_async, t.InlayHintParams(range=whole, **doc), lambda a: a is not None)
    await ask(c.text_document_code_lens_async, t.CodeLensParams(**doc), lambda a: a is not None)
    await ask(c.text_document_document_link_async, t.DocumentLinkParams(**doc), lambda a: a[0].target.endswith("light.glsl"))
    actions = t.CodeActionParams(range=whole, context=t.CodeActionContext([]), **doc)
    await ask(c.text_document_code_action_async, actions, lambda a: a is not None)
    options = t.FormattingOptions(tab_size=4, insert_spaces=True)
    fragment = {"text_document": t.TextDocumentIdentifier(uris["a.frag"])}
    await ask(c.text_document_formatting_async, t.DocumentFormattingParams(options=options, **fragment), lambda a: a)
    await ask(c.text_document_range_formatting_async, t.DocumentRangeFormattingParams(range=whole, options=options, **fragment), lambda a: a)
    items = await ask(c.text_document_prepare_call_hierarchy_async, t.CallHierarchyPrepareParams(**on), lambda a: a)
    await ask(c.call_hierarchy_incoming_calls_async, t.CallHierarchyIncomingCallsParams(items[0]), lambda a: a)
    command = t.ExecuteCommandParams("glisten.configurations", [uris["a.vert"]])
    await ask(c.workspace_execute_command_async, command, lambda a: a == [])
    await c.shutdown_async(None)
    c.exit(None)
    print(f"{n_asked} requests")


asyncio.run(main())
