//! The overloads of a call that is being typed (LSP 3.17, `textDocument/signatureHelp`).
//!
//! *Holds:* all overloads are shown, those of the shader or those of the language, constructors and macros included; the active one is that which the
//! arguments so far fit best. Parentheses that only group leave the call around them.

use super::completion::PROBE;
use super::hover::own_place;
use super::overloads::{Overload, best};
use crate::analysis::Analysis;
use crate::builtins;
use crate::constructors::{self, Constructor};
use crate::cut::{cut, is_in_comment, open_brackets};
use crate::describe;
use crate::state::{Point, State};
use glisten_front::analysis::Denoted;
use glisten_front::builtin::functions::{Row, Signature};
use glisten_front::builtin::sentences;
use glisten_front::hir::{Stage, Types};
use glisten_front::index::View;
use lsp_types::{
    Documentation, ParameterInformation, ParameterLabel, SignatureHelp, SignatureHelpParams, SignatureInformation,
};
use std::ops::Range;

/// The largest number of arguments whose types are looked for: each takes a compilation.
const MAX_TYPED: usize = 8;
/// The largest number of elements of an array whose constructor lists all of them.
const MAX_ELEMENTS: usize = 16;

/// Answers the request.
pub(super) fn help(state: &mut State<'_>, params: &SignatureHelpParams) -> Option<SignatureHelp> {
    let point = state.point(&params.text_document_position_params)?;
    let text = point.text.text.get(..point.offset)?;
    if is_in_comment(text, point.offset) {
        return None;
    }
    let call = call(text)?;
    let word = text.get(call.name.clone())?;
    let overloads = overloads(state, &point, word, &call)?;
    let active = match overloads.len() {
        0 => return None,
        1 => 0,
        _ => best(&overloads, &argument_types(state, &point, &call)),
    };
    let n_commas = call.arguments.len() - 1;
    let signatures = overloads.into_iter().map(|overload| overload.shown).collect();
    Some(SignatureHelp { signatures, active_signature: Some(active as u32), active_parameter: Some(n_commas as u32) })
}

/// A call that is not complete.
struct Call {
    /// The name that is called, or an array's type with its brackets.
    name: Range<usize>,
    /// The arguments so far, the last one up to the end of the text.
    arguments: Vec<Range<usize>>,
}

/// The innermost open call.
fn call(text: &str) -> Option<Call> {
    for (place, sign) in open_brackets(text).into_iter().rev() {
        match sign {
            '(' => {}
            '[' => continue,
            _ => return None,
        }
        let before = text.get(..place)?.trim_end();
        let start = start_of_callee(before);
        if start == before.len() {
            // It groups an operand.
            continue;
        }
        let inside = text.get(place + 1..)?;
        let is_comma = |index: usize| {
            inside.get(..index).is_some_and(|before| open_brackets(before).is_empty()) && !is_in_comment(inside, index)
        };
        let commas = inside.match_indices(',').map(|(index, _)| index).filter(|index| is_comma(*index));
        let ends: Vec<usize> = commas.chain([inside.len()]).map(|index| place + 1 + index).collect();
        let starts = std::iter::once(place + 1).chain(ends.iter().map(|end| end + 1));
        let arguments = starts.zip(&ends).map(|(start, end)| start..*end).collect();
        return Some(Call { name: start..before.len(), arguments });
    }
    None
}

/// Where the name before a parenthesis begins, with the brackets of an array's type; the end of the text if there is none.
fn start_of_callee(before: &str) -> usize {
    let mut name = before;
    while name.ends_with(']') {
        let mut depth = 0_usize;
        let open = name.char_indices().rev().find(|(_, letter)| {
            match letter {
                ']' => depth += 1,
                '[' => depth -= 1,
                _ => {}
            }
            depth == 0
        });
        let Some((open, _)) = open else { return before.len() };
        name = name.get(..open).unwrap_or("").trim_end();
    }
    let start = name.trim_end_matches(|letter: char| letter.is_ascii_alphanumeric() || letter == '_').len();
    if start == name.len() { before.len() } else { start }
}

/// The types of the arguments so far, as far as they are known: each is read in the place of the call.
fn argument_types(state: &mut State<'_>, point: &Point, call: &Call) -> Vec<Option<String>> {
    let text = &point.text.text;
    let before = text.get(..call.name.start).unwrap_or("");
    let mut types = Vec::new();
    for argument in &call.arguments {
        let own = text.get(argument.clone()).unwrap_or("").trim();
        let is_readable = !own.is_empty() && types.len() < MAX_TYPED && open_brackets(own).is_empty();
        types.push(is_readable.then(|| type_of(state, point, &format!("{before}({own}\n).{PROBE}"))).flatten());
    }
    // Nothing is typed yet, so nothing has to take it.
    if let [None] = types.as_slice()
        && call.arguments.iter().all(|argument| text.get(argument.clone()).is_some_and(|own| own.trim().is_empty()))
    {
        types.clear();
    }
    types
}

/// The type of the expression that a text with the probe ends with.
fn type_of(state: &mut State<'_>, point: &Point, text: &str) -> Option<String> {
    let key = &point.analyses.first()?.key;
    let text = cut(text, text.len(), "");
    let compiled = state.project.probe(key, &point.path, text.into(), Some(PROBE))?;
    let mut found = compiled.inspection.views().filter_map(|(_, view)| view.notes.probe.as_ref()?.member_of);
    found.next().filter(|ty| !ty.is_error()).map(|ty| compiled.inspection.types.name(ty))
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

fn overloads(state: &mut State<'_>, point: &Point, name: &str, call: &Call) -> Option<Vec<Overload>> {
    if let Some((element, sizes)) = name.split_once('[') {
        return of_array(point, element.trim_end(), sizes, call).map(|overload| vec![overload]);
    }
    // A macro is replaced before anything else is read (GLSL 1.50 §3.3). While its call is open, it is none.
    for analysis in &point.analyses {
        let rows: Vec<Overload> =
            analysis.views_of(&point.path).into_iter().flat_map(|view| of_macro(view, name)).collect();
        if !rows.is_empty() {
            return Some(rows);
        }
    }
    let named = Point {
        path: point.path.clone(),
        offset: call.name.end,
        text: point.text.clone(),
        analyses: point.analyses.clone(),
    };
    if let Some((analysis, found)) = &state.occurrence(&named) {
        let symbol = analysis.symbol(found.symbol);
        let place = own_place(analysis, &symbol.places, &point.path);
        if let Some((view, Denoted::Function(_) | Denoted::Struct(_))) = place {
            return Some(of_shader(analysis, view, name));
        }
    }
    // A name that the cut text does not resolve yet may still be declared in the whole one.
    if let Some(rows) = in_any_shader(point, name) {
        return Some(rows);
    }
    let view = point.analyses.first()?.views_of(&point.path).into_iter().next()?;
    let rows = builtins::prototypes(name, view.shader.version, builtins::extensions(view), view.shader.stage);
    if rows.is_empty() {
        let rows = constructors::constructors(name, view.shader.version);
        return Some(rows.into_iter().map(|row| of_constructor(name, row)).collect());
    }
    let sentence = sentences::sentence(name).map(str::to_owned);
    Some(rows.into_iter().map(|row| of_builtin(row, view.shader.stage, sentence.clone())).collect())
}

/// The overloads of a name in the first shader that has it as a function or a struct.
fn in_any_shader(point: &Point, name: &str) -> Option<Vec<Overload>> {
    let mut shaders = point.analyses.iter().flat_map(|analysis| {
        analysis.compiled.inspection.views().map(move |(number, _)| of_shader(analysis, number, name))
    });
    shaders.find(|rows| !rows.is_empty())
}

/// The constructor of an array (GLSL 1.50 §5.4.4): `float[2](a, b)`. Its type has the size of the outermost array first.
fn of_array(point: &Point, element: &str, sizes: &str, call: &Call) -> Option<Overload> {
    let (size, inner) = sizes.split_once(']')?;
    let view = point.analyses.first()?.views_of(&point.path).into_iter().next()?;
    let is_type =
        !constructors::constructors(element, view.shader.version).is_empty() || in_any_shader(point, element).is_some();
    let ty = format!("{element}{}", inner.trim());
    let n_named = size.trim().parse().ok().filter(|size| (1..=MAX_ELEMENTS).contains(size));
    let count = n_named.unwrap_or(call.arguments.len());
    let more = n_named.is_none().then(|| "...".to_owned());
    let params: Vec<String> = (0..count).map(|index| format!("{ty} element{index}")).chain(more).collect();
    let name = format!("{element}[{}]{}", size.trim(), inner.trim());
    let shown = signature(&name, "", &params, Some("Takes the elements in order.".to_owned()));
    is_type.then(|| Overload { shown, types: vec![vec![ty; count]] })
}

fn of_macro(view: &View, name: &str) -> Vec<Overload> {
    let rows = view.ast.directives.definitions.iter().filter(|definition| &*definition.name == name);
    let one = |params: &Vec<std::sync::Arc<str>>| {
        let params: Vec<String> = params.iter().map(ToString::to_string).collect();
        Overload { shown: signature(name, "#define", &params, None), types: Vec::new() }
    };
    rows.filter_map(|definition| definition.params.as_ref()).map(one).collect()
}

/// The functions and the constructors of a name in a view.
fn of_shader(analysis: &Analysis, number: usize, name: &str) -> Vec<Overload> {
    let types = &analysis.compiled.inspection.types;
    let Some(view) = analysis.compiled.inspection.view(number) else { return Vec::new() };
    let comment = |denoted: Denoted| {
        let symbols = analysis.index().symbols();
        let mut symbols = symbols.filter(|(_, symbol)| symbol.places.contains(&(number, denoted)));
        symbols.next().and_then(|(_, symbol)| describe::comment(analysis, symbol))
    };
    let functions = view.shader.functions().filter(|(_, function)| function.name == name);
    let mut rows: Vec<Overload> = functions
        .map(|(id, function)| {
            let params = describe::parameters(types, function);
            let shown = signature(name, &types.name(function.ret), &params, comment(Denoted::Function(id)));
            Overload { shown, types: vec![function.params().iter().map(|param| types.name(param.ty)).collect()] }
        })
        .collect();
    for note in &view.notes.names {
        if let Denoted::Struct(id) = note.denoted {
            let structure = types.structure(id);
            if structure.name == name && rows.is_empty() {
                let members = structure.members.iter();
                let params: Vec<String> =
                    members.map(|member| format!("{} {}", types.name(member.ty), member.name)).collect();
                let shown = signature(name, "", &params, comment(Denoted::Struct(id)));
                let types = structure.members.iter().map(|member| types.name(member.ty)).collect();
                rows.push(Overload { shown, types: vec![types] });
            }
        }
    }
    rows
}

fn of_constructor(name: &str, row: Constructor) -> Overload {
    let ty = |param: &String| param.split(' ').next().unwrap_or_default().to_owned();
    let types = vec![row.params.iter().map(ty).collect()];
    Overload { shown: signature(name, "", &row.params, Some(row.sentence.to_owned())), types }
}

fn of_builtin(row: &'static Row, stage: Stage, documentation: Option<String>) -> Overload {
    let label = row.prototype();
    let params = row.params.iter().map(|param| format!("{} {}", param.matcher.spelling(), param.name));
    let parameter = |text: String| ParameterInformation { label: ParameterLabel::Simple(text), documentation: None };
    let shown = SignatureInformation {
        label,
        documentation: documentation.map(Documentation::String),
        parameters: Some(params.map(parameter).collect()),
        active_parameter: None,
    };
    let basic = Types::basic();
    let names = |one: Signature| one.params().iter().map(|(ty, _)| basic.name(*ty)).collect();
    Overload { shown, types: row.signatures(stage).map(names).collect() }
}
