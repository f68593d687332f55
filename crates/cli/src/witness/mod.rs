//! Witnesses: inputs for which the reference shows what a finding on numerics says.
//!
//! *In:* a program, its sources, the stated ranges of its inputs, and the findings of the rules. *Out:* the findings that a run shows, each
//! with the inputs; scenes that show them; and values that are not finite within stated ranges. *Holds:* a finding that no run shows is
//! dropped; one whose shader cannot be run alone stays as it is. The runs are the same every time. *Not done here:* a proof that there
//! is no such input.
//!
//! | file | contents |
//! | --- | --- |
//! | `inputs` | what a stage reads, and what is stated about it |
//! | `stand` | a scene that runs one stage with any inputs |
//! | `samples` | rows of inputs |
//! | `trial` | runs of rows, and the search for one of them |
//! | `depends` | the inputs that an expression depends on |

mod depends;
mod inputs;
mod samples;
mod stand;
mod trial;

use crate::arguments::bounds::Bounds;
use crate::inputs::Group;
use depends::inputs_of;
use glisten_cost::{Assumptions, cost};
use glisten_front::Compiler;
use glisten_front::diagnostic::codes::lints;
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::hir::{BinaryOp, Expr, ExprId, ExprKind, Shader, Stage};
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span};
use glisten_verify::scene::FileSource;
use inputs::Inputs;
use samples::Others;
use stand::{POINTS, Stand};
use std::collections::BTreeMap;
use trial::Trial;

/// The rules whose findings need a witness.
static JUDGED: &[&Code] = &[
    &lints::POW_MAYBE_NEGATIVE,
    &lints::SQRT_MAYBE_NEGATIVE,
    &lints::ACOS_BEYOND_ONE,
    &lints::LOG_OF_ZERO,
    &lints::DIVISION_BY_CLAMPED_ZERO,
    &lints::NORMALIZE_OF_ZERO,
];

/// The most operations of a whole trial. A second of an optimized program runs ten times as many.
const MOST_WORK: u64 = 10_000_000;
/// The rounds that a loop of which nothing is known may take.
const ITERATIONS: u64 = 64;
/// The inputs that a note names.
const MOST_NAMED: usize = 6;

/// A scene that shows a finding.
#[derive(Debug)]
pub(crate) struct Shown {
    /// The name for its files, without an extension.
    pub(crate) name: String,
    /// The scene; its shaders are where the name of the file is `{made}` or the source.
    pub(crate) scene: String,
    /// The extension and the text of the stage that was made for it.
    pub(crate) made: (&'static str, String),
}

/// A place as it is known in several compilations: the name of the file without folders, and the bytes.
type Place = (String, u32, u32);

fn place(sources: &SourceMap, span: Span) -> Option<Place> {
    let file = sources.file(sources.file_of(span)?);
    let name = file.name().rsplit(['/', '\\']).next().unwrap_or("").to_owned();
    Some((name, span.start.checked_sub(file.base())?, span.end.checked_sub(file.base())?))
}

/// A program whose findings are judged.
pub(crate) struct Case<'a> {
    /// Its files.
    pub(crate) group: &'a Group,
    /// The program.
    pub(crate) program: &'a Program,
    /// Its texts.
    pub(crate) sources: &'a SourceMap,
    /// The stated ranges of inputs, by name.
    pub(crate) ranges: &'a [(String, Bounds)],
    /// The compiler that made it.
    pub(crate) compiler: &'a Compiler,
    /// Where its files are read again.
    pub(crate) files: &'a dyn FileSource,
    /// By how much the work of a trial is divided.
    pub(crate) haste: u64,
}

/// Whether a finding is told only with a witness.
#[cfg(feature = "lsp")]
pub(crate) fn is_judged(finding: &Diagnostic) -> bool {
    JUDGED.iter().any(|code| code.id == finding.code.id)
}

/// Whether anything is stated about the inputs of a program.
#[cfg(feature = "lsp")]
pub(crate) fn has_ranges(program: &Program, sources: &SourceMap, ranges: &[(String, Bounds)]) -> bool {
    program.stages.iter().any(|shader| Inputs::of(program, shader, sources, ranges).any_stated())
}

/// Judges the findings of a program by runs, and adds what stated ranges lead to.
pub(crate) fn settle(
    case: &Case<'_>,
    wanted: impl Fn(&Code) -> bool,
    mut found: Vec<Diagnostic>,
) -> (Vec<Diagnostic>, Vec<Shown>) {
    let mut shown = Vec::new();
    let Case { program, sources, ranges, .. } = *case;
    for shader in &program.stages {
        let is_judged = |finding: &Diagnostic| {
            JUDGED.iter().any(|code| code.id == finding.code.id) && is_in(shader, finding.primary.span)
        };
        let has_findings = found.iter().any(is_judged);
        let inputs = Inputs::of(program, shader, sources, ranges);
        let looks = inputs.any_stated() && wanted(&lints::NON_FINITE_IN_RANGE);
        if !has_findings && !looks {
            continue;
        }
        let Some((stand, draws)) = stand_of(case, shader, &inputs) else { continue };
        let stage = Subject { shader, sources, inputs: &inputs, stand: &stand };
        if has_findings
            && let Some(trial) = {
                let wanted = found.iter().filter(|one| is_judged(one)).flat_map(|one| stage.places_of(one)).collect();
                Trial::run(&stand, &inputs, (Others::Any, draws), Some(&wanted))
            }
        {
            found = found
                .into_iter()
                .filter_map(|finding| {
                    if is_judged(&finding) { stage.witnessed(&trial, finding, &mut shown) } else { Some(finding) }
                })
                .collect();
        }
        if looks && let Some(trial) = Trial::run(&stand, &inputs, (Others::Tame, draws), None) {
            stage.in_ranges(&trial, &mut found, &mut shown);
        }
    }
    (found, shown)
}

/// Whether a place is that of an expression of a stage.
fn is_in(shader: &Shader, span: Span) -> bool {
    shader.exprs.iter().any(|expr| expr.span == span)
}

/// A scene that runs the stage, and the draws that are not too much work, if its file can be read again.
fn stand_of(case: &Case<'_>, shader: &Shader, inputs: &Inputs) -> Option<(Stand, usize)> {
    let assumptions = Assumptions { iterations: ITERATIONS, ..Assumptions::default() };
    let costs = cost(case.program, case.sources, &assumptions);
    let weight = costs.stages.iter().find(|stage| stage.stage == shader.stage.name())?.longest.weight();
    let draws = MOST_WORK / case.haste.max(1) / weight.max(1).saturating_mul(POINTS as u64);
    let draws = usize::try_from(draws).unwrap_or(usize::MAX).min(trial::DRAWS);
    if draws == 0 {
        return None;
    }
    let mut files = case.group.inputs.iter().filter(|input| input.stage == shader.stage);
    let (file, None) = (files.next()?, files.next()) else { return None };
    if file.part.is_some() || !matches!(shader.stage, Stage::Vertex | Stage::Fragment) {
        return None;
    }
    Some((Stand::new(file.path.as_deref()?, shader, inputs, (case.compiler, case.files))?, draws))
}

/// A stage whose findings are judged.
struct Subject<'a> {
    shader: &'a Shader,
    sources: &'a SourceMap,
    inputs: &'a Inputs,
    stand: &'a Stand,
}

impl Subject<'_> {
    /// The places of the operations that show a finding.
    fn places_of(&self, finding: &Diagnostic) -> Vec<Place> {
        let users = users(self.shader, finding.primary.span).into_iter();
        users.filter_map(|(_, parent)| place(self.sources, parent.span)).collect()
    }

    /// The finding with inputs that show it; nothing if no run did.
    fn witnessed(&self, trial: &Trial<'_>, finding: Diagnostic, shown: &mut Vec<Shown>) -> Option<Diagnostic> {
        for (id, parent) in users(self.shader, finding.primary.span) {
            let Some(at) = place(self.sources, parent.span) else { continue };
            let Some(row) = trial.row_of(&at) else { continue };
            let note = self.told(&row, id);
            shown.extend(self.shown(&row, finding.code, finding.primary.span));
            return Some(finding.note(note));
        }
        None
    }

    /// Adds the values that are not finite within stated ranges and that no finding names.
    fn in_ranges(&self, trial: &Trial<'_>, found: &mut Vec<Diagnostic>, shown: &mut Vec<Shown>) {
        let mut by_place: BTreeMap<Place, (ExprId, Span)> = BTreeMap::new();
        for (index, expr) in self.shader.exprs.iter().enumerate() {
            if let (true, Some(at)) = (may_be_born(expr), place(self.sources, expr.span)) {
                // Only `push` makes handles, so they are found by their places.
                if let Some(id) = self.shader.expr_at(expr.span).filter(|id| id.index() >= index) {
                    by_place.insert(at, (id, expr.span));
                }
            }
        }
        for at in trial.places() {
            let Some((id, span)) = by_place.get(&at).copied() else { continue };
            let is_told = found.iter().any(|one| {
                let inside = one.primary.span.start >= span.start && one.primary.span.end <= span.end;
                inside && one.code.group() == lints::NON_FINITE_IN_RANGE.group()
            });
            if is_told {
                continue;
            }
            let Some(row) = trial.row_of(&at) else { continue };
            let message = "this is infinite or NaN for inputs within their stated ranges";
            let finding = Diagnostic::new(&lints::NON_FINITE_IN_RANGE, span, message).note(self.told(&row, id));
            shown.extend(self.shown(&row, &lints::NON_FINITE_IN_RANGE, span));
            found.push(finding.help("rule these inputs out here, or state a narrower range"));
        }
    }

    /// The inputs of a row that an expression depends on.
    fn told(&self, row: &[f32], id: ExprId) -> String {
        let depends = inputs_of(self.shader, id);
        let mut named = self.inputs.named(row, |global| depends.contains(&global));
        if named.is_empty() {
            named = self.inputs.named(row, |_| true);
        }
        let more = named.len().saturating_sub(MOST_NAMED);
        named.truncate(MOST_NAMED);
        match named.as_slice() {
            [] => "the reference computes it so, whatever the inputs are".to_owned(),
            _ if more > 0 => format!("the reference computes it so with {}, and {more} more inputs", named.join(", ")),
            _ => format!("the reference computes it so with {}", named.join(", ")),
        }
    }

    fn shown(&self, row: &[f32], code: &Code, span: Span) -> Option<Shown> {
        let line = self.sources.location(self.sources.call_site(span))?;
        let file = self.sources.file(line.file).name();
        let stem = file.rsplit(['/', '\\']).next().unwrap_or(file).replace('.', "_");
        let name = format!("{stem}_{}_{}", line.line, code.id.to_ascii_lowercase());
        let (scene, made) = self.stand.scene_of(self.inputs, row, &name)?;
        Some(Shown { name, scene, made })
    }
}

/// The calls and divisions that have an expression at this place as an operand.
fn users(shader: &Shader, span: Span) -> Vec<(ExprId, &Expr)> {
    let mut users = Vec::new();
    for expr in &shader.exprs {
        let named = match &expr.kind {
            ExprKind::BuiltinCall(_, arguments) => arguments.as_slice(),
            ExprKind::Binary(BinaryOp::Div, _, divisor) | ExprKind::Assign(Some(BinaryOp::Div), _, divisor) => {
                std::slice::from_ref(divisor)
            }
            _ => continue,
        };
        if let Some(id) = named.iter().find(|id| shader.expr(**id).span == span) {
            users.push((*id, expr));
        }
    }
    users
}

/// Whether an expression may yield a number that is not finite from finite operands.
fn may_be_born(expr: &Expr) -> bool {
    matches!(
        expr.kind,
        ExprKind::BuiltinCall(..)
            | ExprKind::Binary(..)
            | ExprKind::Assign(Some(_), ..)
            | ExprKind::Unary(..)
            | ExprKind::Convert(_)
    )
}
