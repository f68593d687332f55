//! `glisten lib`: the library of lighting models as a list, as one page per module, as files, and as a table of its
//! errors; panoramas for it.

use super::args::ResultFormat;
use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Failure, Outcome};
use super::journal;
use super::library_export::{ExportArgs, export};
use super::library_prefilter::{PrefilterArgs, prefilter};
use super::scenes::{gpu_failure, open_gpu};
use crate::evaluate::EvaluateError;
use crate::library::{Cost, Entry, FunctionEntry, Header, entries, entry, modules};
use crate::measure::{Figures, Form, Trial, forms};
use clap::{Args, Subcommand, ValueEnum};
use glisten_front::diagnostic::did_you_mean;
use glisten_gpu::{Gpu, Via};
use glisten_reference::Precision;
use serde::Serialize;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten lib list", "the modules of the library"),
    ("glisten lib show phong", "what a module computes"),
    ("glisten lib export shaders/glisten", "the texts of all modules"),
    ("glisten lib export --wgsl src/shaders", "the modules as WGSL, for shaders that are written in it"),
    ("glisten lib export --rust -D GLISTEN_LIGHTS=16 src", "the structs of the uniforms, with 16 lights"),
    ("glisten lib prefilter room.hdr -o maps", "the light of a panorama, for the module `environment`"),
];

/// Use the library of lighting models
#[derive(Args, Debug)]
pub(super) struct LibArgs {
    #[command(subcommand)]
    command: LibCommand,
}

#[derive(Debug, Subcommand)]
enum LibCommand {
    /// List all modules
    List {
        /// The format of the list
        #[arg(long, value_enum, default_value_t)]
        format: ResultFormat,
    },
    /// Show a module: its equation, its functions, their cost and their errors
    Show {
        /// A module or a function: `phong`, `phongFactor`
        name: String,
        /// Print the text of the module instead
        #[arg(long, conflicts_with = "format")]
        source: bool,
        /// The format of the page
        #[arg(long, value_enum, default_value_t)]
        format: ResultFormat,
    },
    /// Write all modules, and the programs made of them, as files that include each other
    Export(ExportArgs),
    /// Prefilter a panorama for the module `environment`
    Prefilter(PrefilterArgs),
    /// Measure every function against its closed form in f64
    Measure {
        /// The modules to measure (default: all)
        modules: Vec<String>,
        /// The number of random inputs for each function
        #[arg(long, value_name = "N", default_value_t = 4096, value_parser = clap::value_parser!(u32).range(1..=262_144))]
        rows: u32,
        /// The CPU reference only, or the GPU as well
        #[arg(long, value_enum, default_value_t)]
        backend: MeasureBackends,
        /// The GPU to use, by a part of its name, or `software`
        #[arg(long, value_name = "NAME")]
        adapter: Option<String>,
        /// The format of the table
        #[arg(long, value_enum, default_value_t)]
        format: ResultFormat,
    },
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum MeasureBackends {
    /// The CPU reference in f64 and f32
    Cpu,
    /// The CPU reference, and Vulkan through wgpu
    #[default]
    Both,
}

impl LibArgs {
    /// Whether a driver draws.
    pub(super) fn draws_by_a_driver(&self) -> bool {
        matches!(self.command, LibCommand::Measure { backend: MeasureBackends::Both, .. })
    }
}

/// Runs the command.
pub(super) fn run(args: &LibArgs, console: &Console) -> Outcome {
    let text = match &args.command {
        LibCommand::List { format: ResultFormat::Human } => list(),
        LibCommand::List { format: ResultFormat::Json } => lines(&entries().iter().map(summary).collect::<Vec<_>>()),
        LibCommand::Show { name, source, format } => show(&find(name)?, *source, *format)?,
        LibCommand::Export(args) => return export(args, console),
        LibCommand::Prefilter(args) => return prefilter(args, console),
        LibCommand::Measure { modules, rows, backend, adapter, format } => {
            let gpu = match backend {
                MeasureBackends::Cpu => None,
                MeasureBackends::Both => Some(open_gpu(adapter.as_deref()).map_err(gpu_failure)?),
            };
            measure(modules, *rows as usize, gpu.as_ref(), *format)?
        }
    };
    console.output(&text)?;
    Ok(Exit::Ok)
}

fn lines(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).expect("names and numbers are always JSON") + "\n"
}

/// The module with this name, or with a function of this name.
fn find(name: &str) -> Result<Entry, Failure> {
    let file = name.trim_start_matches("glisten/").trim_end_matches(".glsl");
    if let Some(module) = modules().iter().find(|module| module.name == file) {
        return Ok(entry(module));
    }
    let entries = entries();
    let names = entries.iter().flat_map(|entry| entry.functions.iter().map(|function| function.name.as_str()));
    let near = did_you_mean(file, modules().iter().map(|module| module.name).chain(names)).map(str::to_owned);
    let has = |entry: &Entry| entry.functions.iter().any(|function| function.name == file);
    entries.into_iter().find(has).ok_or_else(|| {
        let failure = Failure::usage(format!("the library has no `{name}`"));
        match near {
            Some(near) => failure.help(format!("did you mean `{near}`? `glisten lib list` names all modules")),
            None => failure.help("`glisten lib list` names all modules"),
        }
    })
}

/// The most expensive function of a module.
fn dearest(entry: &Entry) -> Option<Cost> {
    entry.functions.iter().map(|function| function.cost).max_by_key(|cost| cost.weight())
}

fn list() -> String {
    let entries = entries();
    let width = |of: fn(&Entry) -> &str| entries.iter().map(|entry| of(entry).chars().count()).max().unwrap_or(0);
    let (names, kinds) = (width(|entry| entry.header.name), width(|entry| entry.header.kind));
    let mut text = format!("{:names$}  {:kinds$}  {:>4}  {:>4}  equation\n", "module", "kind", "ops", "div");
    for entry in &entries {
        let (header, cost) = (entry.header, dearest(entry).unwrap_or_default());
        text += &format!(
            "{:names$}  {:kinds$}  {:>4}  {:>4}  {}\n",
            header.name, header.kind, cost.arithmetic, cost.special, header.equation
        );
    }
    text + "\nops and div are the operations, and the divisions and transcendentals among them not counted, of a module's\n\
            dearest function. `glisten lib show MODULE` tells more; a shader includes <glisten/MODULE.glsl>.\n"
}

/// A module as JSON, with its keys in order.
#[derive(Serialize)]
struct Summary<'a> {
    name: &'a str,
    kind: &'a str,
    equation: &'a str,
    source: &'a str,
    functions: Vec<&'a str>,
    cost: Option<Cost>,
    stability: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    notes: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    function_entries: Option<&'a [FunctionEntry]>,
}

fn summary(entry: &Entry) -> Summary<'_> {
    let mut functions: Vec<&str> = entry.functions.iter().map(|function| function.name.as_str()).collect();
    functions.dedup();
    let Header { name, kind, equation, source, stability } = entry.header;
    let cost = dearest(entry);
    Summary { name, kind, equation, source, functions, cost, stability, notes: None, function_entries: None }
}

fn told(form: &Form, error: &EvaluateError) -> Failure {
    Failure::new(Exit::Content, format!("internal error: {}: {error}", form.signature))
        .help("this is a fault of glisten; please report it")
}

fn show(entry: &Entry, source: bool, format: ResultFormat) -> Result<String, Failure> {
    if source {
        return Ok(entry.module.text.to_owned());
    }
    if format == ResultFormat::Json {
        let notes = Some(entry.notes.as_str()).filter(|notes| !notes.is_empty());
        return Ok(lines(&Summary { notes, function_entries: Some(&entry.functions), ..summary(entry) }));
    }
    let header = entry.header;
    let mut text = format!("{} ({})\n\n", header.name, header.kind);
    for (name, value) in [("Equation", header.equation), ("Source", header.source), ("Stability", header.stability)] {
        text += &format!("{name:10} {value}\n");
    }
    text += &format!("Include    #include <glisten/{}.glsl>\n", header.name);
    if !entry.notes.is_empty() {
        text += &format!("\n{}\n", wrapped(&entry.notes, ""));
    }
    for function in &entry.functions {
        text += &format!("\n{}\n{}\n", function.declaration, wrapped(&function.documentation, "    "));
        text += &format!("    Cost: {}.\n", function.cost);
        if let Some(form) = forms().find(|form| form.signature == function.signature && form.module == header.name) {
            text += &format!("    Error: {}.\n", error_of(form)?);
        }
    }
    Ok(text)
}

/// The errors of a function over a few inputs, measured now.
fn error_of(form: &'static Form) -> Result<String, Failure> {
    let trial = Trial::new(form, 1024).map_err(|error| told(form, &error))?;
    let figures = |precision| trial.reference(precision).map_err(|error| told(form, &error));
    let (wide, single) = (figures(Precision::F64)?, figures(Precision::F32)?);
    Ok(format!(
        "at most {} ULP in f64 and {} in f32, over {} inputs",
        short(wide.ulps),
        short(single.error),
        wide.counted
    ))
}

/// Wraps paragraphs to lines of at most 100 characters after an indent; indented lines are unchanged.
fn wrapped(text: &str, indent: &str) -> String {
    const WIDTH: usize = 100;
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.lines() {
        if paragraph.is_empty() || paragraph.starts_with(' ') {
            lines.push(format!("{indent}{paragraph}").trim_end().to_owned());
            continue;
        }
        let mut line = indent.to_owned();
        for word in paragraph.split_whitespace() {
            if line.trim().is_empty() {
                line.push_str(word);
            } else if line.chars().count() + 1 + word.chars().count() > WIDTH {
                lines.push(std::mem::replace(&mut line, format!("{indent}{word}")));
            } else {
                line.push(' ');
                line.push_str(word);
            }
        }
        lines.push(line);
    }
    lines.join("\n")
}

/// The figures of a function: in f64, in f32, on the GPU.
struct FigureRow {
    form: &'static Form,
    wide: Figures,
    single: Figures,
    gpu: Option<Figures>,
}

fn measure(names: &[String], rows: usize, gpu: Option<&Gpu>, format: ResultFormat) -> Result<String, Failure> {
    let modules = names.iter().map(|name| Ok(find(name)?.header.name)).collect::<Result<Vec<&str>, Failure>>()?;
    let mut measured = Vec::new();
    for form in forms().filter(|form| modules.is_empty() || modules.contains(&form.module)) {
        let trial = Trial::new(form, rows).map_err(|error| told(form, &error))?;
        let reference = |precision| trial.reference(precision).map_err(|error| told(form, &error));
        let drawn = match gpu {
            None => None,
            Some(gpu) => {
                let _work = journal::at_work(&format!("measuring `{}`", form.signature));
                let scene = trial.scene().map_err(|error| told(form, &error))?;
                let rendered = gpu.render(&scene, Via::Spirv).map_err(gpu_failure)?;
                Some(trial.picture(&rendered.picture))
            }
        };
        measured.push(FigureRow {
            form,
            wide: reference(Precision::F64)?,
            single: reference(Precision::F32)?,
            gpu: drawn,
        });
    }
    Ok(match format {
        ResultFormat::Human => table(&measured),
        ResultFormat::Json => lines(&measured.iter().map(RowJson::from).collect::<Vec<_>>()),
    })
}

/// The table, which is also Markdown.
fn table(rows: &[FigureRow]) -> String {
    let head = ["function", "inputs", "f64 (ULP)", "f32", "GPU"].map(str::to_owned);
    let cells = |row: &FigureRow| {
        let gpu = row.gpu.map_or("-".to_owned(), |figures| short(figures.error));
        let name = format!("`{}`", row.form.signature);
        [name, row.wide.counted.to_string(), short(row.wide.ulps), short(row.single.error), gpu]
    };
    let all: Vec<[String; 5]> = std::iter::once(head).chain(rows.iter().map(cells)).collect();
    let widths: [usize; 5] =
        std::array::from_fn(|column| all.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let line = |row: &[String; 5]| {
        let cells = row.iter().zip(widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!(" {cell:width$} "),
            _ => format!(" {cell:>width$} "),
        });
        format!("|{}|\n", cells.collect::<Vec<_>>().join("|"))
    };
    let rule = widths.iter().enumerate().map(|(column, width)| match column {
        0 => format!(" {} ", "-".repeat(*width)),
        _ => format!(" {}:", "-".repeat(*width)),
    });
    let rule = format!("|{}|\n", rule.collect::<Vec<_>>().join("|"));
    all.iter().enumerate().map(|(index, row)| if index == 0 { line(row) + &rule } else { line(row) }).collect()
}

/// Two significant digits.
fn short(number: f64) -> String {
    if number == 0.0 {
        "0".to_owned()
    } else if number.is_infinite() {
        "inf".to_owned()
    } else if (0.095..100.0).contains(&number) {
        format!("{number:.1}")
    } else {
        format!("{number:.1e}")
    }
}

/// A row as JSON, with its keys in order. Infinite errors are null.
#[derive(Serialize)]
struct RowJson {
    module: &'static str,
    function: &'static str,
    inputs: usize,
    undecided: usize,
    f64_ulp: f64,
    f32_error: f64,
    gpu_error: Option<f64>,
    gpu_non_finite: Option<usize>,
}

impl From<&FigureRow> for RowJson {
    fn from(row: &FigureRow) -> Self {
        Self {
            module: row.form.module,
            function: row.form.signature,
            inputs: row.wide.counted,
            undecided: row.wide.undecided,
            f64_ulp: row.wide.ulps,
            f32_error: row.single.error,
            gpu_error: row.gpu.map(|figures| figures.error),
            gpu_non_finite: row.gpu.map(|figures| figures.non_finite),
        }
    }
}
