//! The columns of the table of figures: what each shows, by what it is sorted, and what it means.
//!
//! *In:* a variant. *Out:* cells. *Holds:* a column's help is a sentence that needs no other; keys of figures that there are not
//! are empty, and the script sorts them last.

use super::super::model::{OnFront, Report, Way};
use glisten_page::words::{NONE, fixed, grouped, interval, mesh, scientific};
use minijinja::{Value, context};

/// A column.
pub(super) struct Column {
    /// The name in the page's script.
    id: &'static str,
    head: &'static str,
    help: &'static str,
    text: fn(&Way) -> String,
    /// The number that it is sorted by; texts are sorted as they are.
    key: Option<fn(&Way) -> f64>,
}

/// All columns but the first, which is the variant's name.
pub(super) static COLUMNS: &[Column] = &[
    Column {
        id: "model",
        head: "Model",
        help: "Variants of one model are compared with one reference, and have one front.",
        text: |way| way.model.clone(),
        key: None,
    },
    Column {
        id: "kind",
        head: "Kind",
        help: "Declared in the scene, as written, or the kind of change by which the variant was found.",
        text: |way| way.kind.to_owned(),
        key: None,
    },
    Column {
        id: "rmse",
        head: "RMSE",
        help: "The root mean square difference of a color channel from the reference; 1 is full intensity.",
        text: |way| scientific(way.error.rmse),
        key: Some(|way| way.error.rmse),
    },
    Column {
        id: "max_abs",
        head: "Largest error",
        help: "The largest difference of a color channel from the reference; 1 is full intensity.",
        text: |way| scientific(way.error.max_abs),
        key: Some(|way| way.error.max_abs),
    },
    Column {
        id: "flip",
        head: "FLIP",
        help: "How much of the difference a person sees when flipping between the picture and the reference: 0 is none, 1 is all.",
        text: |way| way.error.flip.map_or_else(|| NONE.into(), scientific),
        key: Some(|way| way.error.flip.unwrap_or(f64::NAN)),
    },
    Column {
        id: "operations",
        head: "Operations",
        help: "The work: what the CPU reference executes for the picture, by the table of weights. The same on every machine.",
        text: |way| grouped(way.work.operations),
        key: Some(|way| way.work.operations as f64),
    },
    Column {
        id: "ratio",
        head: "Time",
        help: "The median of the ratios to the baseline's time, round by round: below 1 is faster than the baseline.",
        text: |way| fixed(way.ratio.median, 2),
        key: Some(|way| way.ratio.median),
    },
    Column {
        id: "interval",
        head: "95 %",
        help: "The interval that holds the median ratio with a confidence of 95 %. Sorted by its lower end.",
        text: |way| interval(way.ratio.interval),
        key: Some(|way| way.ratio.interval[0]),
    },
    Column {
        id: "pareto",
        head: "Front by work",
        help: "Yes: no other variant of the model takes less work and is nearer to the reference by its RMSE.",
        text: |way| if way.pareto { "yes" } else { "no" }.to_owned(),
        key: Some(|way| f64::from(u8::from(!way.pareto))),
    },
    Column {
        id: "pareto_time",
        head: "Front by time",
        help: "Yes or no if the measured times decide it, open if the difference may be noise.",
        text: |way| way.pareto_time.name().to_owned(),
        key: Some(|way| match way.pareto_time {
            OnFront::Yes => 0.0,
            OnFront::Open => 1.0,
            OnFront::No => 2.0,
        }),
    },
    Column {
        id: "lookups",
        head: "Lookups",
        help: "Texture lookups for the picture.",
        text: |way| grouped(way.work.texture_lookups),
        key: Some(|way| way.work.texture_lookups as f64),
    },
    Column {
        id: "max_ulp",
        head: "ULP",
        help: "The largest difference in units in the last place of the reference as a 32-bit number.",
        text: |way| scientific(way.error.max_ulp),
        key: Some(|way| way.error.max_ulp),
    },
    Column {
        id: "psnr",
        head: "PSNR",
        help: "The peak signal-to-noise ratio in decibels against a peak of 1; infinite for equal pictures.",
        text: |way| way.error.psnr.map_or_else(|| "\u{221e}".into(), |psnr| format!("{psnr:.1}")),
        key: Some(|way| way.error.psnr.unwrap_or(f64::MAX)),
    },
    Column {
        id: "rounding",
        head: "Rounding",
        help: "The largest difference from the same variant in 64-bit arithmetic: the part of the error that rounding alone makes.",
        text: |way| scientific(way.rounding.max_abs),
        key: Some(|way| way.rounding.max_abs),
    },
    Column {
        id: "edges",
        head: "Edge pixels",
        help: "Pixels that only one of the picture and the reference covers. They count in no other figure but FLIP.",
        text: |way| grouped(way.error.coverage_mismatch),
        key: Some(|way| way.error.coverage_mismatch as f64),
    },
    Column {
        id: "non_finite",
        head: "Not finite",
        help: "Pixels with a NaN or an infinity. A variant that has more of them than another is on no front.",
        text: |way| grouped(way.error.non_finite),
        key: Some(|way| way.error.non_finite as f64),
    },
    Column {
        id: "vertices",
        head: "Vertices",
        help: "Invocations of the vertex stage, one for each distinct vertex of an instance.",
        text: |way| grouped(way.work.vertices),
        key: Some(|way| way.work.vertices as f64),
    },
    Column {
        id: "fragments",
        head: "Fragments",
        help: "Invocations of the fragment stage, without helper invocations.",
        text: |way| grouped(way.work.fragments),
        key: Some(|way| way.work.fragments as f64),
    },
    Column {
        id: "milliseconds",
        head: "GPU ms",
        help: "The median GPU time of a frame in milliseconds, by timestamp queries.",
        text: |way| fixed(way.milliseconds, 3),
        key: Some(|way| way.milliseconds),
    },
    Column {
        id: "mesh",
        head: "Mesh",
        help: "Segments and rings of the mesh, if it was tessellated for the report.",
        text: |way| mesh(way.tessellation).unwrap_or_else(|| "as in the scene".into()),
        key: Some(|way| way.tessellation.map_or(f64::NAN, |[a, b]| f64::from(a) * f64::from(b))),
    },
];

/// The heads of all columns.
pub(super) fn heads() -> Vec<Value> {
    let head = |column: &Column| {
        let is_text = column.key.is_none();
        context! { id => column.id, head => column.head, help => column.help, is_text }
    };
    COLUMNS.iter().map(head).collect()
}

/// The cells of a variant, with what they are sorted by.
pub(super) fn cells(way: &Way) -> Vec<Value> {
    let cell = |column: &Column| {
        let key = column.key.map(|key| key(way)).map(|key| if key.is_nan() { String::new() } else { key.to_string() });
        let text = (column.text)(way);
        context! { id => column.id, key => key.as_deref().unwrap_or(&text), text, is_text => column.key.is_none() }
    };
    COLUMNS.iter().map(cell).collect()
}

/// The sentence about the variants that could not be drawn, if there are any.
pub(super) fn skipped(report: &Report) -> Vec<Value> {
    let one = |skipped: &super::super::model::Skipped| {
        context! { name => &skipped.name, model => &skipped.model, because => &skipped.because }
    };
    report.skipped.iter().map(one).collect()
}
