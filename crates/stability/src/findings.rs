//! [`Findings`]: what an examination found, at places in the text.
//!
//! *In:* a scene, its texts, and the [`Examination`]. *Out:* the form of `glisten stability --format json`. *Holds:* one
//! cause an expression, and one a line unless kinds differ; causes are sorted by harm.

use super::advice::advice;
use super::recomputed::ExactFound;
use super::rewrite::{Reload, Tried, tried};
use glisten_front::diagnostic::{Diagnostic, codes, write};
use glisten_front::source::SourceMap;
use glisten_reference::stability::{Cause, CauseKind, Examination, ExamineOptions, examine, inputs_at};
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
            let color = |picture: &glisten_scene::picture::Picture| {
                let pixel = picture.attachments.first().and_then(|pixels| pixels.get(index)).copied();
                pixel.unwrap_or_default().map(finite)
            };
            let inputs = inputs_at(scene, [x, y])?;
            let inputs = inputs.into_iter().map(|(name, values)| (name, values.into_iter().map(finite).collect()));
            Some(WorstPixel {
                x,
                y,
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

/// The causes at their places, without those that repeat a line and a kind.
fn placed(
    scene: &Scene,
    sources: &SourceMap,
    (examined, bound): (&Examination, f64),
    reload: Option<Reload<'_>>,
) -> Vec<CauseFound> {
    let before = Before { error: examined.all_errors.largest(), bound, is_finite: examined.is_finite_in_exact() };
    let mut list: Vec<CauseFound> = Vec::new();
    for cause in &examined.causes {
        let tried = match reload {
            Some(reload) if list.len() < MOST_REWRITINGS && !cause.ill_posed => {
                tried((scene, &examined.exact), sources, cause, reload)
            }
            _ => None,
        };
        let help = advice(scene, cause) + &tried.map_or_else(String::new, |tried| outcome(&tried, &before));
        let diagnostic = diagnostic(cause, &help);
        let Some(finding) = write::findings(sources, [&diagnostic]).pop() else { continue };
        let region = finding.region;
        let is_known = list.iter().any(|known| {
            (&known.file, known.line, known.kind) == (&region.file, region.line, cause.kind.name())
                && known.stage == cause.stage.name()
        });
        if is_known {
            continue;
        }
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
            undefined: cause.undefined,
            f64_enough: None,
            help,
            diagnostic,
        });
    }
    list
}

/// The picture before a rewriting.
struct Before {
    /// Its largest error.
    error: f64,
    /// The error that is accepted.
    bound: f64,
    /// Whether the exact picture has a number everywhere.
    is_finite: bool,
}

/// The result of a rewriting, compared with the error before.
fn outcome(Tried { text, error, change }: &Tried, before: &Before) -> String {
    let text: Vec<&str> = text.split_whitespace().collect();
    let text = text.join(" ");
    if error.is_infinite() {
        return format!(". Tried: `{text}` alone leaves pixels that are not finite");
    }
    let is_little = *error > 0.5 * before.error || before.error.is_infinite() && *error > before.bound;
    if is_little && *change > 0.5 * error {
        return format!(". Tried: `{text}` does not help, because it draws another picture (error {error:.1e})");
    }
    if *error > 0.5 * before.error {
        return format!(
            ". Tried: `{text}` alone does not help (error {error:.1e}), because its operands have lost digits, too"
        );
    }
    let rest = if before.is_finite { "" } else { " where the exact picture is finite; elsewhere it draws its own" };
    format!(". Tried: with `{text}`, the error of the picture is {error:.1e}{rest}")
}

fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
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
        _ if cause.non_finite > 0 && cause.non_finite == cause.non_finite_in_exact => {
            "this is not finite in exact arithmetic either: the formula has no answer here"
        }
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
