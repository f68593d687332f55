//! The overloads of a call that is being typed (LSP 3.17, `textDocument/signatureHelp`).
//!
//! *Holds:* all overloads are shown, those of the shader or those of the language, constructors included; the one that has enough parameters comes
//! first.

use super::hover::own_place;
use crate::analysis::Analysis;
use crate::builtins;
use crate::constructors::{self, Constructor};
use crate::cut::{is_in_comment, open_brackets};
use crate::describe;
use crate::state::{Point, State};
use glisten_front::analysis::Denoted;
use glisten_front::builtin::{functions::Row, sentences};
use glisten_front::index::{SymbolKind, View};
use lsp_types::{
    Documentation, ParameterInformation, ParameterLabel, SignatureHelp, SignatureHelpParams, SignatureInformation,
};
use std::ops::Range;

/// Answers the request.
pub(super) fn help(state: &mut State<'_>, params: &SignatureHelpParams) -> Option<SignatureHelp> {
    let point = state.point(&params.text_document_position_params)?;
    let text = point.text.text.get(..point.offset)?;
    if is_in_comment(text, point.offset) {
        return None;
    }
    let (name, n_commas) = call(text)?;
    let word = text.get(name.clone())?;
    let signatures = signatures(state, &point, word, name)?;
    if signatures.is_empty() {
        return None;
    }
    let fits = |signature: &SignatureInformation| {
        signature.parameters.as_ref().is_some_and(|parameters| parameters.len() > n_commas)
    };
    let active = signatures.iter().position(fits).unwrap_or(0);
    Some(SignatureHelp { signatures, active_signature: Some(active as u32), active_parameter: Some(n_commas as u32) })
}

/// The name of the innermost open call, and the number of commas in it so far.
fn call(text: &str) -> Option<(Range<usize>, usize)> {
    let open = open_brackets(text);
    let at = open.iter().rposition(|(_, sign)| *sign != '[')?;
    let &(place, '(') = open.get(at)? else { return None };
    let before = text.get(..place)?.trim_end();
    let start = before.trim_end_matches(|letter: char| letter.is_ascii_alphanumeric() || letter == '_').len();
    if start == before.len() {
        return None;
    }
    let inside = text.get(place + 1..)?;
    let mut n_commas = 0;
    for (index, letter) in inside.char_indices() {
        if letter == ',' && open_brackets(inside.get(..index)?).is_empty() && !is_in_comment(inside, index) {
            n_commas += 1;
        }
    }
    Some((start..before.len(), n_commas))
}

fn signature(name: &str, ret: &str, params: &[String], documentation: Option<String>) -> SignatureInformation {
    let label = format!("{ret}{}{name}({})", if ret.is_empty() { "" } else { " " }, params.join(", "));
    let parameter =
        |text: &String| ParameterInformation { label: ParameterLabel::Simple(text.clone()), documentation: None };
    SignatureInformation {
        label,
        documentation: documentation.map(Documentation::String),
        parameters: Some(params.iter().map(parameter).collect()),
        active_parameter: None,
    }
}

fn signatures(
    state: &mut State<'_>,
    point: &Point,
    name: &str,
    range: Range<usize>,
) -> Option<Vec<SignatureInformation>> {
    let named = Point {
        path: point.path.clone(),
        offset: range.end,
        text: point.text.clone(),
        analyses: point.analyses.clone(),
    };
    let found = state.occurrence(&named);
    let is_macro =
        found.as_ref().is_some_and(|(analysis, found)| analysis.symbol(found.symbol).kind == SymbolKind::Macro);
    for analysis in &point.analyses {
        for view in analysis.views_of(&point.path) {
            if is_macro {
                let rows = of_macro(view, name);
                if !rows.is_empty() {
                    return Some(rows);
                }
            }
        }
    }
    if let Some((analysis, found)) = &found {
        let symbol = analysis.symbol(found.symbol);
        let place = own_place(analysis, &symbol.places, &point.path);
        if let Some((view, Denoted::Function(_) | Denoted::Struct(_))) = place {
            return Some(of_shader(analysis, view, name));
        }
    }
    // A name that the cut text does not resolve yet may still be declared in the whole one.
    let shaders = point.analyses.iter().flat_map(|analysis| {
        analysis.compiled.inspection.views().map(move |(number, _)| of_shader(analysis, number, name))
    });
    if let Some(rows) = shaders.into_iter().find(|rows| !rows.is_empty()) {
        return Some(rows);
    }
    let view = point.analyses.first()?.views_of(&point.path).into_iter().next()?;
    let rows = builtins::prototypes(name, view.shader.version, builtins::extensions(view), view.shader.stage);
    if rows.is_empty() {
        let rows = constructors::constructors(name, view.shader.version);
        return Some(rows.into_iter().map(|row| of_constructor(name, row)).collect());
    }
    let sentence = sentences::sentence(name).map(str::to_owned);
    Some(rows.into_iter().map(|row| of_builtin(row, sentence.clone())).collect())
}

fn of_macro(view: &View, name: &str) -> Vec<SignatureInformation> {
    let rows = view.ast.directives.definitions.iter().filter(|definition| &*definition.name == name);
    let one = |params: &Vec<std::sync::Arc<str>>| {
        let params: Vec<String> = params.iter().map(ToString::to_string).collect();
        signature(name, "#define", &params, None)
    };
    rows.filter_map(|definition| definition.params.as_ref()).map(one).collect()
}

/// The functions and the constructors of a name in a view.
fn of_shader(analysis: &Analysis, number: usize, name: &str) -> Vec<SignatureInformation> {
    let types = &analysis.compiled.inspection.types;
    let Some(view) = analysis.compiled.inspection.view(number) else { return Vec::new() };
    let comment = |denoted: Denoted| {
        let symbols = analysis.index().symbols();
        let mut symbols = symbols.filter(|(_, symbol)| symbol.places.contains(&(number, denoted)));
        symbols.next().and_then(|(_, symbol)| describe::comment(analysis, symbol))
    };
    let functions = view.shader.functions().filter(|(_, function)| function.name == name);
    let mut rows: Vec<SignatureInformation> = functions
        .map(|(id, function)| {
            let params = describe::parameters(types, function);
            signature(name, &types.name(function.ret), &params, comment(Denoted::Function(id)))
        })
        .collect();
    for note in &view.notes.names {
        if let Denoted::Struct(id) = note.denoted {
            let structure = types.structure(id);
            if structure.name == name && rows.is_empty() {
                let members = structure.members.iter();
                let params: Vec<String> =
                    members.map(|member| format!("{} {}", types.name(member.ty), member.name)).collect();
                rows.push(signature(name, "", &params, comment(Denoted::Struct(id))));
            }
        }
    }
    rows
}

fn of_constructor(name: &str, row: Constructor) -> SignatureInformation {
    signature(name, "", &row.params, Some(row.sentence.to_owned()))
}

fn of_builtin(row: &Row, documentation: Option<String>) -> SignatureInformation {
    let label = row.prototype();
    let params = row.params.iter().map(|param| format!("{} {}", param.matcher.spelling(), param.name));
    let parameter = |text: String| ParameterInformation { label: ParameterLabel::Simple(text), documentation: None };
    SignatureInformation {
        label,
        documentation: documentation.map(Documentation::String),
        parameters: Some(params.map(parameter).collect()),
        active_parameter: None,
    }
}
