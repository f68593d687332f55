//! Matches the outputs of one stage with the inputs of the next (GLSL 1.50 §4.3.4, §4.3.6, §4.3.7, §4.3.9).
//!
//! Variables match by name, blocks by block name. Matching declarations must agree in type and qualifiers. A
//! declaration in only one stage is superfluous and legal, unless the later stage reads it. The inputs of a geometry
//! shader are arrays of what the vertex shader writes.

use super::Linker;
use super::compatible::{Free, MemberDifference, block_parts, compare_members, same_type, with_members};
use super::usage::{is_assigned, uses};
use crate::diagnostic::{Applicability, Diagnostic, Edit, Fix, codes, did_you_mean};
use crate::hir::{ArraySize, Global, GlobalId, Sampling, Shader, Stage, Storage, Type, TypeId, Types};
use crate::language::Feature;
use crate::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// Whether a global is an ordinary output or input, which needs a partner in the other stage.
fn is_interface(global: &Global, storage: Storage) -> bool {
    global.storage == storage && global.builtin.is_none()
}

/// The outputs of a stage, by the keys with which an input finds them.
pub(super) struct Outputs<'a> {
    producer: &'a Shader,
    by_name: FxHashMap<(&'a str, bool), GlobalId>,
    by_location: FxHashMap<(u32, u32, bool), GlobalId>,
}

impl<'a> Outputs<'a> {
    /// The outputs of `producer`. Of several with the same name or location, the first counts.
    pub(super) fn new(producer: &'a Shader) -> Self {
        let (mut by_name, mut by_location) = (FxHashMap::default(), FxHashMap::default());
        for (id, output) in producer.globals().filter(|(_, output)| is_interface(output, Storage::Out)) {
            let is_block = output.block.is_some();
            by_name.entry((output.match_name(), is_block)).or_insert(id);
            if let Some(location) = output.location {
                by_location.entry((location, output.component.unwrap_or(0), is_block)).or_insert(id);
            }
        }
        Self { producer, by_name, by_location }
    }

    /// The output that feeds an input: one of the same explicit location (GLSL 4.10 §4.4.1), or, if neither has one, of the
    /// same name and kind (OpenGL 4.5 §7.4.1).
    pub(super) fn partner(&self, input: &Global) -> Option<(GlobalId, &'a Global)> {
        let is_block = input.block.is_some();
        let by_location = || self.by_location.get(&(input.location?, input.component.unwrap_or(0), is_block));
        let by_name = || {
            let id = self.by_name.get(&(input.match_name(), is_block))?;
            let has_none = input.location.is_none() && self.producer.global(*id).location.is_none();
            has_none.then_some(id)
        };
        let id = *by_location().or_else(by_name)?;
        Some((id, self.producer.global(id)))
    }
}

/// The outputs of a stage with the inputs of the next one that they feed.
pub fn partners(producer: &Shader, consumer: &Shader) -> Vec<(GlobalId, GlobalId)> {
    let outputs = Outputs::new(producer);
    let inputs = consumer.globals().filter(|(_, input)| is_interface(input, Storage::In));
    inputs.filter_map(|(id, input)| Some((outputs.partner(input)?.0, id))).collect()
}

/// For how many inputs without a partner the help text searches all outputs.
const MAX_SUGGESTIONS: usize = 16;

/// Checks all inputs of `consumer` against the outputs of `producer`.
pub(super) fn check(ctx: &mut Linker<'_>, producer: &Shader, consumer: &Shader) {
    if let Some(problem) = super::per_vertex::check_stages(ctx.types, producer, consumer) {
        ctx.report(problem);
    }
    check_variables(ctx, producer, consumer, true);
}

/// Checks the inputs that are declared in `consumer`. If `producer` is not `complete`, it may have more outputs.
pub(super) fn check_variables(ctx: &mut Linker<'_>, producer: &Shader, consumer: &Shader, complete: bool) {
    let inputs = consumer.globals().filter(|(_, input)| is_interface(input, Storage::In));
    let outputs = Outputs::new(producer);
    let mut n_lonely = 0;
    for (_, input) in inputs {
        match outputs.partner(input) {
            Some((id, output)) => {
                check_pair(ctx, producer, output, consumer, input);
                if complete && input.used && !output.written {
                    check_written(ctx, (producer, id), output, consumer, input);
                }
            }
            // What the fixed-function pipeline names is declared in every stage (1.20 §7.6); what is not written is undefined.
            None if input.is_fixed() => {}
            None if input.used && complete => {
                n_lonely += 1;
                no_partner(ctx, producer, consumer, input, n_lonely <= MAX_SUGGESTIONS);
            }
            None => {}
        }
    }
}

/// Reports an input whose output is never written, which the versions before 1.50 forbid: "Only those varying variables
/// used (i.e. read) in the fragment shader must be written to by the vertex shader" (1.10 §4.3.6). Later ones leave the value
/// undefined, which is a lint.
fn check_written(
    ctx: &mut Linker<'_>,
    (producer, id): (&Shader, GlobalId),
    output: &Global,
    consumer: &Shader,
    input: &Global,
) {
    let allowed = [producer, consumer].iter().any(|shader| shader.version.has(Feature::UnwrittenInputs));
    if allowed || input.name.starts_with("gl_") || is_assigned(producer, id) {
        return;
    }
    let (name, reader, writer) = (input.match_name(), consumer.stage.name(), producer.stage.name());
    let message = format!("the {reader} stage reads `{name}`, which the {writer} stage never writes");
    ctx.report(
        Diagnostic::new(&codes::link::NO_MATCHING_OUTPUT, input.span, message)
            .here("it has no value")
            .label(output.span, format!("declared in the {writer} stage"))
            .help(format!("assign to `{name}` in the {writer} stage")),
    );
}

fn no_partner(ctx: &mut Linker<'_>, producer: &Shader, consumer: &Shader, input: &Global, suggest: bool) {
    let outputs: Vec<&Global> = producer.globals.iter().filter(|output| is_interface(output, Storage::Out)).collect();
    let (name, stage) = (input.match_name(), producer.stage.name());
    let kind = if input.block.is_some() { "block" } else { "input" };
    let message = format!(
        "the {} stage reads the {kind} `{name}`, and the {stage} stage has no such output",
        consumer.stage.name()
    );
    let mut diagnostic = Diagnostic::new(&codes::link::NO_MATCHING_OUTPUT, input.span, message);
    if !suggest {
        ctx.report(diagnostic);
        return;
    }
    let same_name = producer.globals.iter().find(|global| global.match_name() == name && global.builtin.is_none());
    let same_location =
        || outputs.iter().copied().find(|output| is_at(output) && is_at(input) && output.location == input.location);
    if let Some(other) = same_name.or_else(same_location) {
        let what = match (other.storage, other.location, input.location) {
            (Storage::Out, Some(there), Some(here)) if is_at(other) && is_at(input) => {
                let (from, to) = (other.component.unwrap_or(0), input.component.unwrap_or(0));
                match there == here {
                    true => format!("at component {from} of location {there}, not at component {to}"),
                    false => format!("at location {there}, not {here}"),
                }
            }
            (Storage::Out, None, Some(here)) if is_same_kind(other, input) => {
                format!("without a location, and not at location {here}")
            }
            (Storage::Out, Some(there), None) if is_same_kind(other, input) => {
                format!("at location {there}, and the input has none")
            }
            // Blocks of one name and kind are apart by their locations alone.
            (Storage::Out, Some(there), Some(here)) if other.block.is_some() && input.block.is_some() => {
                diagnostic = diagnostic.help(format!("write `layout(location = {there})` here, or leave both out"));
                format!("at location {there}, not {here}")
            }
            _ => format!("as {}", describe_other(other)),
        };
        diagnostic = diagnostic.label(other.span, format!("the {stage} stage has `{}` {what}", other.match_name()));
    }
    if let Some(location) = same_name.and_then(|other| mixed_location(other, input)) {
        ctx.report(diagnostic.help(format!("write `layout(location = {location})` in both stages, or in none")));
        return;
    }
    // Another name mends nothing where one has a location.
    let outputs: Vec<&Global> = outputs.into_iter().filter(|output| !is_at(output) && !is_at(input)).collect();
    let near = did_you_mean(name, outputs.iter().map(|output| output.match_name()));
    let near = near.and_then(|near| outputs.iter().copied().find(|output| output.match_name() == near));
    if let Some(output) = near.or_else(|| only_unread(ctx.types, &outputs, consumer, input)) {
        diagnostic = diagnostic
            .label(output.span, format!("the nearest output of the {stage} stage"))
            .help(format!("did you mean `{}`?", output.match_name()));
        if let Some(fix) = renaming(consumer, input, output.match_name()) {
            diagnostic = diagnostic.fix(fix);
        }
    } else if same_name.is_none() {
        diagnostic = diagnostic
            .help(format!("declare it in the {stage} stage: `{}`", declaration(ctx.types, producer, consumer, input)));
    }
    ctx.report(diagnostic);
}

/// Whether both are blocks, or neither is.
fn is_same_kind(output: &Global, input: &Global) -> bool {
    output.block.is_some() == input.block.is_some()
}

/// The location that one of an output and an input states, and the other one does not.
fn mixed_location(output: &Global, input: &Global) -> Option<u32> {
    let is_mixed = output.storage == Storage::Out && is_same_kind(output, input);
    match (output.location, input.location) {
        (Some(location), None) | (None, Some(location)) if is_mixed => Some(location),
        _ => None,
    }
}

/// Whether a variable that is no block has an explicit location.
fn is_at(global: &Global) -> bool {
    global.location.is_some() && global.block.is_none()
}

/// The fix that gives an input the name of an output, everywhere in its shader.
fn renaming(consumer: &Shader, input: &Global, name: &str) -> Option<Fix> {
    // A name of a block, or one that the shader has already, is no simple matter.
    let is_free =
        input.block.is_none() && !name.contains('.') && consumer.globals.iter().all(|other| other.name != name);
    let edit = |span: Span| Edit { span, text: name.to_owned() };
    let edits = || consumer.globals().find(|(_, other)| other.span == input.span).map(|(id, _)| uses(consumer, id));
    let edits = if is_free { edits()? } else { return None };
    let edits = [input.span].into_iter().chain(edits).map(edit).collect();
    Some(Fix { title: format!("call it `{name}`"), applicability: Applicability::Unsafe, edits })
}

fn describe_other(global: &Global) -> &'static str {
    match (global.storage, global.block.is_some()) {
        (_, true) => "a block",
        (Storage::Out, false) => "an output outside a block",
        (Storage::In, false) => "an input",
        (Storage::Uniform, false) => "a uniform",
        (Storage::Const | Storage::Private, false) => "a global variable",
    }
}

/// The output of the input's type that no input reads, if there is exactly one.
fn only_unread<'a>(types: &Types, outputs: &[&'a Global], consumer: &Shader, input: &Global) -> Option<&'a Global> {
    let inputs = consumer.globals.iter().filter(|other| is_interface(other, Storage::In));
    let taken: FxHashSet<&str> = inputs.map(Global::match_name).collect();
    let wanted = per_vertex(types, consumer.stage, input.ty)?;
    let mut free = outputs
        .iter()
        .copied()
        .filter(|output| !taken.contains(output.match_name()) && same_type(types, output.ty, wanted));
    let first = free.next()?;
    free.next().is_none().then_some(first)
}

/// The declaration of an output that would feed an input, as GLSL.
fn declaration(types: &Types, producer: &Shader, consumer: &Shader, input: &Global) -> String {
    if let Some(block) = &input.block {
        return format!("out {} {{ .. }};", block.name);
    }
    let ty = if consumer.stage == Stage::Geometry { types.element(input.ty).unwrap_or(input.ty) } else { input.ty };
    let sampling = input.sampling.prefix();
    // The versions before 1.30 and ES 3.00 have no `out` there (1.20 §4.3.6).
    let word = if producer.version.has(Feature::InOut) { "out" } else { "varying" };
    let place = input.location.map_or_else(String::new, |location| format!("layout(location = {location}) "));
    format!("{place}{}{sampling}{word} {} {};", interpolation_prefix(input), types.name(ty), input.name)
}

fn interpolation_prefix(global: &Global) -> String {
    if global.interpolation_written { format!("{} ", global.interpolation.name()) } else { String::new() }
}

fn check_pair(ctx: &mut Linker<'_>, producer: &Shader, output: &Global, consumer: &Shader, input: &Global) {
    let has = |feature| [producer, consumer].iter().any(|shader| shader.version.has(feature));
    let free = Free {
        invariant: has(Feature::InvariantOutputAlone),
        interpolation: has(Feature::InterpolationOfInput),
        sampling: has(Feature::SamplingOfInput),
        smooth: has(Feature::SmoothByDefault),
    };
    let pair = Pair { producer: producer.stage, output, consumer: consumer.stage, input, free };
    if input.block.is_some() {
        check_block(ctx, &pair);
    } else {
        check_type(ctx, &pair);
    }
    check_qualifiers(ctx, &pair);
}

struct Pair<'a> {
    producer: Stage,
    output: &'a Global,
    consumer: Stage,
    input: &'a Global,
    free: Free,
}

impl Pair<'_> {
    fn report(
        &self,
        ctx: &mut Linker<'_>,
        code: &'static crate::diagnostic::Code,
        what: &str,
        theirs: String,
        ours: String,
    ) {
        ctx.report(self.finding(code, what, theirs, ours));
    }

    fn finding(&self, code: &'static crate::diagnostic::Code, what: &str, theirs: String, ours: String) -> Diagnostic {
        let name = self.input.match_name();
        let message = format!("`{name}` {what}");
        Diagnostic::new(code, self.input.span, message)
            .here(format!("{ours} in the {} stage", self.consumer.name()))
            .label(self.output.span, format!("{theirs} in the {} stage", self.producer.name()))
    }
}

/// The type of an input for one vertex: a geometry shader declares an array of it.
fn per_vertex(types: &Types, consumer: Stage, ty: TypeId) -> Option<TypeId> {
    if consumer != Stage::Geometry {
        return Some(ty);
    }
    match types.get(ty) {
        Type::Array(element, _) => Some(element),
        Type::Error => Some(ty),
        _ => None,
    }
}

fn check_type(ctx: &mut Linker<'_>, pair: &Pair<'_>) {
    let types = ctx.types;
    let matches =
        per_vertex(types, pair.consumer, pair.input.ty).is_some_and(|input| same_type(types, input, pair.output.ty));
    if !matches {
        let theirs = format!("`{}`", types.name(pair.output.ty));
        let ours = match per_vertex(types, pair.consumer, pair.input.ty) {
            Some(ty) if pair.consumer == Stage::Geometry => format!("`{}` of each vertex", types.name(ty)),
            _ => format!("`{}`", types.name(pair.input.ty)),
        };
        let same_spelling = theirs == ours;
        let what =
            if same_spelling { "is not the same struct in both stages" } else { "changes its type between the stages" };
        let finding = pair.finding(&codes::link::INTERFACE_TYPE_MISMATCH, what, theirs, ours);
        let input = per_vertex(types, pair.consumer, pair.input.ty).unwrap_or(pair.input.ty);
        ctx.report(with_members(finding, types, (input, pair.consumer), (pair.output.ty, pair.producer)));
    }
}

fn check_block(ctx: &mut Linker<'_>, pair: &Pair<'_>) {
    let types = ctx.types;
    let (Some((output, output_size)), Some((input, input_size))) =
        (block_parts(types, pair.output.ty), block_parts(types, pair.input.ty))
    else {
        return;
    };
    if !block_arrays_match(pair.consumer, output_size, input_size) {
        let array = |size: Option<ArraySize>| match size {
            None => "no array".to_owned(),
            Some(ArraySize::Sized(size)) => format!("an array of {size}"),
            Some(ArraySize::Unsized) => "an unsized array".to_owned(),
        };
        let what = "is another array of blocks in each stage";
        pair.report(ctx, &codes::link::INTERFACE_BLOCK_MISMATCH, what, array(output_size), array(input_size));
        return;
    }
    if let Some(difference) = compare_members(types, output, input, pair.free) {
        let diagnostic = member_difference(types, &codes::link::INTERFACE_BLOCK_MISMATCH, pair, &difference);
        ctx.report(diagnostic);
    }
}

fn block_arrays_match(consumer: Stage, output: Option<ArraySize>, input: Option<ArraySize>) -> bool {
    match consumer {
        Stage::Geometry => output.is_none() && input.is_some(),
        Stage::Vertex | Stage::Fragment => output == input,
    }
}

fn member_difference(
    types: &Types,
    code: &'static crate::diagnostic::Code,
    pair: &Pair<'_>,
    difference: &MemberDifference<'_>,
) -> Diagnostic {
    let name = pair.input.match_name();
    let (producer, consumer) = (pair.producer.name(), pair.consumer.name());
    match *difference {
        MemberDifference::Count(theirs, ours) => Diagnostic::new(
            code,
            pair.input.span,
            format!("the block `{name}` has another number of members in each stage"),
        )
        .here(format!("{ours} in the {consumer} stage"))
        .label(pair.output.span, format!("{theirs} in the {producer} stage")),
        MemberDifference::Declaration(theirs, ours) => {
            Diagnostic::new(code, ours.span, format!("the members of the block `{name}` differ between the stages"))
                .here(format!("`{} {}` in the {consumer} stage", types.name(ours.ty), ours.name))
                .label(theirs.span, format!("`{} {}` in the {producer} stage", types.name(theirs.ty), theirs.name))
        }
        MemberDifference::Qualifiers(theirs, ours) => {
            let message = format!("`{}` of the block `{name}` is qualified differently in each stage", ours.name);
            Diagnostic::new(code, ours.span, message)
                .here(format!("{} in the {consumer} stage", member_qualifiers(ours)))
                .label(theirs.span, format!("{} in the {producer} stage", member_qualifiers(theirs)))
        }
    }
}

fn member_qualifiers(member: &crate::hir::Member) -> String {
    let interpolation = member.interpolation.map_or("no interpolation qualifier", crate::hir::Interpolation::name);
    let sampling = member.sampling.word().map_or(String::new(), |word| format!(" {word}"));
    let invariant = if member.invariant { ", `invariant`" } else { "" };
    format!("{interpolation}{sampling}{invariant}")
}

/// "The type and presence of the interpolation qualifiers and storage qualifiers and invariant qualifiers … must
/// match" (§4.3.9): `smooth` and no qualifier differ, too. From 4.20 and ES 3.00 on, an invariant output "will still match an input of
/// a subsequent stage without the input being declared as invariant" (GLSL 4.20 §4.8.1). From 4.30 on, the other qualifiers may differ,
/// too: "what matters is what is declared in the fragment shaders" (4.30 §4.3.4, which 4.40 takes an older sentence of §4.5 back for), for which [`Varying`](super::Varying) has them.
fn check_qualifiers(ctx: &mut Linker<'_>, pair: &Pair<'_>) {
    let Pair { output, input, .. } = pair;
    let interpolation = |global: &Global| {
        let written = global.interpolation_written.then_some(global.interpolation);
        pair.free.interpolation_of(written)
    };
    if input.block.is_none() && !pair.free.interpolation && interpolation(output) != interpolation(input) {
        let word = |global: &Global| {
            interpolation(global)
                .map_or("no interpolation qualifier".to_owned(), |written| format!("`{}`", written.name()))
        };
        let what = "is interpolated differently in each stage";
        pair.report(ctx, &codes::link::INTERPOLATION_MISMATCH, what, word(output), word(input));
    }
    let is = |global: &Global, sampling| global.sampling == sampling;
    let is_free = pair.free.invariant && !input.invariant;
    let sampling = |sampling| [output, input].map(|global| !pair.free.sampling && is(global, sampling));
    let flags = [
        ("centroid", sampling(Sampling::Centroid)),
        ("sample", sampling(Sampling::Sample)),
        ("invariant", [output.invariant && !is_free, input.invariant]),
    ];
    for (qualifier, [theirs, ours]) in flags {
        if theirs != ours {
            let word = |set: bool| if set { format!("`{qualifier}`") } else { format!("not `{qualifier}`") };
            let what = format!("is `{qualifier}` in one stage alone");
            pair.report(ctx, &codes::link::QUALIFIER_MISMATCH, &what, word(theirs), word(ours));
        }
    }
}
