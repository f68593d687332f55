//! [`Findings`]: what an examination found, at places in the text.
//!
//! *In:* a scene, its texts, and the [`Examination`]. *Out:* the form of `glisten stability --format json`. *Holds:* one
//! cause an expression, and one a line unless kinds differ, which tells the places of the others; causes are sorted by harm.

use super::advice::advice;
use super::recomputed::ExactFound;
use super::rewrite::{Reload, Tried, tried};
use glisten_front::diagnostic::{Diagnostic, codes, write};
use glisten_front::source::SourceMap;
use glisten_reference::stability::{
    CAUSE_BITS, Cause, CauseKind, ErrorMap, Examination, ExamineOptions, examine, inputs_at,
};
use glisten_scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;

/// The number of causes for which a rewriting is tried.
const MOST_REWRITINGS: usize = 4;

/// The findings in a scene. The keys are those of the contract.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// `stable`, `degraded` or `broken`.
    pub verdict: &'static str,
    /// The figures of the picture.
    pub picture: PictureFigures,
    /// The number of results that are not finite in f32 although their operands are.
    pub non_finite: u64,
    /// The causes, worst first.
    pub causes: Vec<CauseFound>,
    /// The error of the reference by 192 bits, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact: Option<ExactFound>,
}

/// The difference between the picture of f32 arithmetic and the exact one.
#[derive(Clone, Debug, Serialize)]
pub struct PictureFigures {
    /// The largest finite difference of a channel.
    pub max_abs: f64,
    /// The largest finite difference as a share of the pixel's largest channel, which counts as 1 if it is less.
    pub max_relative: f64,
    /// The root of the mean squared difference over the pixels.
    pub rmse: f64,
    /// The pixel with the largest difference; `None` if there is no difference.
    pub worst: Option<WorstPixel>,
}

/// The worst pixel.
#[derive(Clone, Debug, Serialize)]
pub struct WorstPixel {
    /// The column from the left.
    pub x: u32,
    /// The row from the top.
    pub y: u32,
    /// The attachment in which that is.
    pub attachment: u32,
    /// Its color in f32; `None` for a channel that is not finite.
    pub f32: [Option<f64>; 4],
    /// Its exact color.
    pub exact: [Option<f64>; 4],
    /// The varyings at that pixel in exact arithmetic.
    pub inputs: BTreeMap<String, Vec<Option<f64>>>,
}

/// A pixel.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spot {
    /// The column from the left.
    pub x: u32,
    /// The row from the top.
    pub y: u32,
}

/// Where an expression begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Start {
    /// The line from 1.
    pub line: u32,
    /// The column from 1.
    pub column: u32,
}

/// A cause at its place.
#[derive(Clone, Debug, Serialize)]
pub struct CauseFound {
    /// The file as the user named it.
    pub file: String,
    /// First line.
    pub line: u32,
    /// First column.
    pub column: u32,
    /// Last line.
    pub end_line: u32,
    /// One past the last column.
    pub end_column: u32,
    /// `vertex` or `fragment`.
    pub stage: &'static str,
    /// The kind.
    pub kind: &'static str,
    /// See [`Cause::harm`].
    pub harm: Option<f64>,
    /// See [`Cause::lost_bits`].
    pub lost_bits: f64,
    /// See [`Cause::condition`].
    pub condition: f64,
    /// See [`Cause::non_finite`].
    pub non_finite: u64,
    /// See [`Cause::disagreements`].
    pub disagreements: u64,
    /// Where the harm is largest.
    #[serde(rename = "where")]
    pub at: Spot,
    /// Whether the exact result jumps there, so that no rewriting helps.
    pub ill_posed: bool,
    /// Where the line has more causes of this kind, apart from this one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<Start>,
    /// See [`Cause::undefined`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undefined: Option<&'static str>,
    /// Whether f64 is enough at that pixel, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub f64_enough: Option<bool>,
    /// Advice: the text to write instead.
    pub help: String,
    /// The finding for writers of diagnostics.
    #[serde(skip)]
    pub diagnostic: Diagnostic,
}

/// Examines a scene and places what is found. With `reload`, rewritings that are mechanical are tried, and the help texts say
/// whether they help.
///
/// # Errors
/// The errors of [`examine`].
pub fn find(
    scene: &Scene,
    sources: &SourceMap,
    options: &mut ExamineOptions<'_>,
    reload: Option<Reload<'_>>,
) -> Result<(Findings, Examination), Vec<Diagnostic>> {
    let examined = examine(scene, options)?;
    let picture = figures(scene, &examined)?;
    let causes = placed(scene, sources, (&examined, options.bound), reload);
    let verdict = examined.verdict.name();
    Ok((Findings { verdict, picture, non_finite: examined.non_finite, causes, exact: None }, examined))
}

fn figures(scene: &Scene, examined: &Examination) -> Result<PictureFigures, Vec<Diagnostic>> {
    let (errors, all) = (&examined.errors, &examined.all_errors);
    let worst = errors.first_not_finite().or_else(|| errors.worst().or_else(|| all.worst()).map(|(index, _)| index));
    let worst = match worst {
        None => None,
        Some(index) => {
            let [x, y] = errors.place(index);
            let attachment = examined.attachment_at(index);
            let color = |picture: &glisten_scene::picture::Picture| {
                let pixel = picture.attachments.get(attachment).and_then(|pixels| pixels.get(index)).copied();
                pixel.unwrap_or_default().map(finite)
            };
            let inputs = inputs_at(scene, [x, y])?;
            let inputs = inputs.into_iter().map(|(name, values)| (name, values.into_iter().map(finite).collect()));
            Some(WorstPixel {
                x,
                y,
                attachment: attachment as u32,
                f32: color(&examined.single),
                exact: color(&examined.exact),
                inputs: inputs.collect(),
            })
        }
    };
    let max_abs = all.worst().map_or(0.0, |(_, error)| error);
    Ok(PictureFigures { max_abs, max_relative: all.worst_relative(&examined.exact), rmse: all.rmse(), worst })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The causes at their places; those that repeat a line and a kind are told with the first.
fn placed(
    scene: &Scene,
    sources: &SourceMap,
    (examined, bound): (&Examination, f64),
    reload: Option<Reload<'_>>,
) -> Vec<CauseFound> {
    let before = Before { errors: &examined.all_errors, bound, is_finite: examined.is_finite_in_exact() };
    let mut list: Vec<CauseFound> = Vec::new();
    let mut kept: Vec<&Cause> = Vec::new();
    for cause in &examined.causes {
        let Some(region) = region(sources, cause) else { continue };
        let known = list.iter_mut().find(|known| {
            (&known.file, known.line, known.kind) == (&region.file, region.line, cause.kind.name())
                && known.stage == cause.stage.name()
        });
        if let Some(known) = known {
            if !kept.iter().any(|kept| overlap(kept, cause)) {
                let start = Start { line: region.line, column: region.column };
                known.also.push(start);
                known.diagnostic =
                    known.diagnostic.clone().note(format!("the same at {}:{}", start.line, start.column));
                kept.push(cause);
            }
            continue;
        }
        let tried = match reload {
            Some(reload) if list.len() < MOST_REWRITINGS && !cause.ill_posed => {
                tried((scene, &examined.exact), sources, cause, reload)
            }
            _ => None,
        };
        let help = advice(scene, cause) + &tried.map_or_else(String::new, |tried| outcome(&tried, cause, &before));
        let diagnostic = diagnostic(cause, &help);
        kept.push(cause);
        list.push(CauseFound {
            file: region.file,
            line: region.line,
            column: region.column,
            end_line: region.end_line,
            end_column: region.end_column,
            stage: cause.stage.name(),
            kind: cause.kind.name(),
            harm: cause.harm,
            lost_bits: tenths(cause.lost_bits),
            condition: tenths(cause.condition),
            non_finite: cause.non_finite,
            disagreements: cause.disagreements,
            at: Spot { x: cause.at[0], y: cause.at[1] },
            ill_posed: cause.ill_posed,
            also: Vec::new(),
            undefined: cause.undefined,
            f64_enough: None,
            help,
            diagnostic,
        });
    }
    list
}

/// The place of a cause; `None` if it is not in a file.
fn region(sources: &SourceMap, cause: &Cause) -> Option<write::Region> {
    let finding = write::findings(sources, [&diagnostic(cause, "")]).pop()?;
    Some(finding.region)
}

/// Whether one of two causes of a kind is a part of the other.
fn overlap(a: &Cause, b: &Cause) -> bool {
    a.stage == b.stage && a.kind == b.kind && a.span.start < b.span.end && b.span.start < a.span.end
}

/// The picture before a rewriting.
struct Before<'a> {
    errors: &'a ErrorMap,
    /// The error that is accepted.
    bound: f64,
    /// Whether the exact picture has a number everywhere.
    is_finite: bool,
}

/// The result of a rewriting, compared with the error before.
fn outcome(Tried { text, errors, change }: &Tried, cause: &Cause, before: &Before<'_>) -> String {
    let text: Vec<&str> = text.split_whitespace().collect();
    let text = text.join(" ");
    let (error, error_before) = (errors.largest(), before.errors.largest());
    if error.is_infinite() {
        return format!(". Tried: `{text}` alone leaves pixels that are not finite");
    }
    let is_little = error > 0.5 * error_before || error_before.is_infinite() && error > before.bound;
    if is_little && *change > 0.5 * error {
        return format!(". Tried: `{text}` does not help, because it draws another picture (error {error:.1e})");
    }
    if error > 0.5 * error_before {
        let [x, y] = cause.at;
        let [here, here_before] = [errors, before.errors].map(|errors| errors.at(cause.at));
        if cause.harm.is_some_and(|harm| here_before - here >= 0.5 * harm) {
            return format!(
                ". Tried: with `{text}`, the error at pixel ({x}, {y}) is {here:.1e} instead of {here_before:.1e}; the rest has other \
                 causes (error of the picture {error:.1e})"
            );
        }
        let reason = match cause.kind {
            _ if cause.first_lost_bits < CAUSE_BITS => ", because its operands have lost digits, too",
            CauseKind::Cancellation => ", because the rounding of its operands is magnified, too",
            _ => "",
        };
        return format!(". Tried: `{text}` alone does not help (error {error:.1e}){reason}");
    }
    let rest = if before.is_finite { "" } else { " where the exact picture is finite; elsewhere it draws its own" };
    format!(". Tried: with `{text}`, the error of the picture is {error:.1e}{rest}")
}

fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// Whether no result is finite in f64 that is not finite in f32.
fn is_in_both(cause: &Cause) -> bool {
    cause.non_finite > 0 && cause.non_finite == cause.non_finite_in_exact
}

fn diagnostic(cause: &Cause, help: &str) -> Diagnostic {
    if let Some(what) = cause.undefined {
        let message = format!("GLSL leaves this undefined: {what}");
        let change = cause.harm.unwrap_or(f64::INFINITY);
        let harm = format!("other results change the picture by up to {change:.1e}");
        let figures = format!("for example at pixel ({}, {})", cause.at[0], cause.at[1]);
        return Diagnostic::new(&codes::scenes::UNSTABLE_EXPRESSION, cause.span, message)
            .here(harm)
            .note(figures)
            .help(help);
    }
    let message = match cause.kind {
        _ if cause.ill_posed && cause.disagreements > 0 => "the exact result jumps here: f32 decides it differently",
        _ if cause.ill_posed => "the exact result jumps here when its inputs move by one rounding",
        CauseKind::Overflow if is_in_both(cause) => "this overflows in f32, and in f64 as well",
        _ if is_in_both(cause) => "this is not finite in exact arithmetic either: the formula has no answer here",
        CauseKind::Cancellation => "leading digits cancel here, and the rest is rounding",
        CauseKind::Rounding => "f32 is too coarse for this result",
        CauseKind::Overflow => "this overflows in f32",
        CauseKind::Underflow => "this is too small for f32 and becomes 0",
        CauseKind::Division => "this divides by 0 or by too little",
        CauseKind::Domain => "the argument is outside the domain of this function, or at its edge",
        CauseKind::Power => "the exponent multiplies the error of the base",
        CauseKind::Argument => "f32 has too few digits for this angle",
        CauseKind::Comparison => "f32 decides this comparison differently",
        CauseKind::Conversion => "f32 rounds this to another number",
        CauseKind::Accumulation => "rounding adds up over the iterations",
    };
    let harm = match cause.harm {
        Some(harm) => format!("exact, it would take {harm:.1e} off the error of the picture"),
        None => "it makes pixels that are not finite".to_owned(),
    };
    let figures = format!(
        "{:.1} of 24 bits are lost; worst at pixel ({}, {}); {} results not finite, {} decided differently",
        cause.lost_bits, cause.at[0], cause.at[1], cause.non_finite, cause.disagreements
    );
    Diagnostic::new(&codes::scenes::UNSTABLE_EXPRESSION, cause.span, message).here(harm).note(figures).help(help)
}
