//! Unit tests in GLSL: functions under a comment `//! test`, called on the reference and on a GPU.
//!
//! *In:* a source, of a stage or to include, and a compiler. *Out:* a [`UnitTest`] for each comment, and its [`TestResult`] on a backend.
//!
//! ```glsl
//! //! test x = -1..1
//! void squareIsEven(float x, out float got, out float expected)
//! {
//!     got = square(-x);
//!     expected = square(x);
//! }
//! ```
//!
//! *Holds:* the tolerance is the envelope: what a conforming GPU may compute. Lines are those of the source. A test that cannot run fails,
//! and says why. *Not done here:* which files there are; who draws.

mod block;
mod cases;
mod compare;
mod source;
mod table;
mod value;

use crate::evaluate::{EvaluateError, Evaluator, Text, signature_of};
use crate::numeric::Shape;
use crate::shader_test::{TestBackend, TestResult};
use block::{Block, blocks};
use cases::{Parameter, rows};
use compare::{Expected, Row, call, fault};
use glisten_front::hir::{Function, ParamMode, Scalar, Shader, TypeId, Types};
use glisten_front::index::Inspection;
use glisten_front::source::{SourceMap, Span};
use glisten_front::{Compilation, Compiler};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::Scene;
use glisten_scene::picture::{Interval, Picture};

use source::Bare;
use std::fmt::Write;
use table::Table;
use value::in_order;

pub use block::has_tests;

/// The names of the `out` parameters of a function that compares.
const PAIR: [&str; 2] = ["got", "expected"];
/// The names of the functions that return one of them.
const RETURNING: [&str; 2] = ["glisten_got", "glisten_expected"];

/// A test of a function.
#[derive(Debug)]
pub struct UnitTest {
    /// The name of the function, or the text of the comment if no function follows.
    pub name: String,
    /// The line of the comment.
    pub line: u32,
    prepared: Result<Prepared, TestResult>,
}

/// A test that can run.
#[derive(Debug)]
struct Prepared {
    /// The calls, and those that return what is expected.
    evaluator: Evaluator,
    other: Option<Evaluator>,
    parameters: Vec<Parameter>,
    rows: Vec<Vec<f64>>,
    /// The scalars of the results.
    scalar: Scalar,
    /// The line of each row; that of the comment for rows that are made.
    lines: Vec<u32>,
    expected: Expected,
    tolerance: Option<f64>,
    /// The results of the reference.
    reference: Reference,
}

/// The results of the reference, row by row.
#[derive(Debug)]
struct Reference {
    single: Vec<Vec<f64>>,
    envelope: Vec<Vec<Interval>>,
    others: Vec<Vec<Interval>>,
}

/// The tests of a source called `name`, and its compilation as a shader.
pub fn tests(name: &str, written: &str, compiler: &Compiler) -> (Vec<UnitTest>, Compilation) {
    let bare = Bare::new(written);
    let text = Text { name, version: &bare.version, text: &bare.text };
    let (compilation, inspection) = bare.compile(name, compiler);
    let left_out = LeftOut::of(&compilation, &inspection, name);
    let test = |block: Block| {
        let unnamed = format!("test in line {}", block.line);
        let line = block.line;
        if left_out.has(line) {
            let reason = format!("line {line}: the condition (`#if`) that the comment is under does not hold");
            return UnitTest { name: unnamed, line, prepared: Err(TestResult::Skip(reason)) };
        }
        match Subject::of(&compilation, name, &block, block.group(written)) {
            Ok(subject) => {
                let prepared = subject.prepare(compiler, text, &block).map_err(TestResult::Fail);
                UnitTest { name: subject.function.name.clone(), line, prepared }
            }
            Err(message) => UnitTest { name: unnamed, line, prepared: Err(TestResult::Fail(message)) },
        }
    };
    (blocks(written).into_iter().map(test).collect(), compilation)
}

/// The lines of a text that conditions of the preprocessor leave out.
struct LeftOut {
    /// The first and the last line of each group.
    lines: Vec<[u32; 2]>,
}

impl LeftOut {
    /// Those of the file called `name`.
    fn of(compilation: &Compilation, inspection: &Inspection, name: &str) -> Self {
        let sources = &compilation.sources;
        let line = |at: u32| {
            let location = sources.location(Span::new(at, at))?;
            (sources.file(location.file).name() == name).then_some(location.line)
        };
        let spans = inspection.views().flat_map(|(_, view)| &view.ast.directives.inactive);
        Self { lines: spans.filter_map(|span| Some([line(span.start)?, line(span.end)?])).collect() }
    }

    fn has(&self, line: u32) -> bool {
        self.lines.iter().any(|[first, last]| (*first..*last).contains(&line))
    }
}

/// The function of a test.
struct Subject<'a> {
    types: &'a Types,
    function: &'a Function,
}

impl<'a> Subject<'a> {
    /// The first function behind a comment, up to the last line of the conditional group that the comment is in.
    fn of(compilation: &'a Compilation, name: &str, block: &Block, end: Option<u32>) -> Result<Self, String> {
        let sources = &compilation.sources;
        let Some(program) = &compilation.program else { return Err(told(compilation, name)) };
        let shader: Option<&Shader> = program.stages.first();
        let line = |function: &Function| line_in(sources, name, function);
        let functions = shader.into_iter().flat_map(|shader| &shader.functions);
        let behind = functions.filter(|function| function.body.is_some() && function.name != "main");
        let next = behind
            .filter_map(|function| Some((line(function)?, function)))
            .filter(|(line, _)| *line > block.last)
            .min_by_key(|(line, _)| *line);
        let (line, function) = next.ok_or("no function follows")?;
        if end.is_some_and(|end| line > end) {
            return Err("no function follows under the condition (`#if`) that the comment is under".to_owned());
        }
        Ok(Self { types: &program.types, function })
    }

    fn prepare(&self, compiler: &Compiler, text: Text<'_>, block: &Block) -> Result<Prepared, String> {
        let at =
            |(line, message): (u32, String)| format!("line {}: {message}", if line == 0 { block.line } else { line });
        let table = Table::read(&block.lines).map_err(|unread| at((unread.line, unread.message)))?;
        let parameters = self.parameters().map_err(|message| at((0, message)))?;
        let rows = rows(&table, &parameters).map_err(at)?;
        let is_pair = self.is_pair();
        let mut whole = text.text.to_owned();
        if is_pair {
            RETURNING.iter().zip(PAIR).for_each(|(name, result)| whole += &self.returning(name, result));
        }
        let text = Text { text: &whole, ..text };
        let prepare = |name: &str| {
            let names: Vec<String> = self.passed().map(|parameter| self.types.name(parameter.ty)).collect();
            let signature = format!("{name}({})", names.join(","));
            Evaluator::of_text(compiler, text, &signature, &[]).map_err(|error| at((0, error.to_string())))
        };
        let (evaluator, other) = if is_pair {
            let [got, expected] = RETURNING;
            (prepare(got)?, Some(prepare(expected)?))
        } else {
            let signature = signature_of(self.types, self.function);
            (Evaluator::of_text(compiler, text, &signature, &[]).map_err(|error| at((0, error.to_string())))?, None)
        };
        let compared = if is_pair { self.pair_type() } else { Some(self.function.ret) };
        let shape = compared.and_then(|ty| Shape::of(self.types, ty));
        let scalar = shape.map_or(Scalar::Float, |shape| shape.scalar);
        let is_bool = shape.is_some_and(|shape| shape.scalar == Scalar::Bool && shape.size() == 1);
        let expected = match () {
            () if is_pair => Expected::Same,
            () if !table.rows.is_empty() => {
                let results = evaluator.results();
                let mut all = Vec::new();
                for row in &table.rows {
                    let given: usize = row.expected.iter().map(value::Value::size).sum();
                    if given != results {
                        return Err(at((row.line, format!("{given} numbers are expected of {results}"))));
                    }
                    let numbers = in_order(&row.expected, shape.as_slice());
                    all.push(numbers.map_err(|message| at((row.line, message)))?);
                }
                Expected::Numbers(all)
            }
            () if is_bool => Expected::True,
            () => Expected::Finite,
        };
        let lines = rows.iter().enumerate();
        let lines = lines.map(|(index, _)| table.rows.get(index).map_or(block.line, |row| row.line)).collect();
        let reference = Reference::of(&evaluator, other.as_ref(), &rows).map_err(|error| at((0, error.to_string())))?;
        let tolerance = table.tolerance;
        Ok(Prepared { evaluator, other, parameters, rows, scalar, lines, expected, tolerance, reference })
    }

    /// The parameters that a call passes.
    fn passed(&self) -> impl Iterator<Item = &'a glisten_front::hir::Local> {
        let function = self.function;
        let params = function.params().iter().enumerate();
        params.filter(|(index, _)| function.param_mode(*index) != ParamMode::Out).map(|(_, param)| param)
    }

    fn parameters(&self) -> Result<Vec<Parameter>, String> {
        let mut parameters = Vec::new();
        for (index, param) in self.function.params().iter().enumerate() {
            let name = param.name.clone();
            match self.function.param_mode(index) {
                ParamMode::In | ParamMode::ConstIn => {}
                ParamMode::Out if self.is_pair() => continue,
                _ => {
                    let [got, expected] = PAIR;
                    let message = format!("the parameter `{name}` is not passed in alone");
                    return Err(format!("{message}; a test may have `out` parameters `{got}` and `{expected}`"));
                }
            }
            let Some(shape) = Shape::of(self.types, param.ty) else {
                return Err(format!("`{name}` is of type `{}`, which no number fills", self.types.name(param.ty)));
            };
            parameters.push(Parameter { name, shape });
        }
        Ok(parameters)
    }

    /// Whether the function has the parameters `out got` and `out expected` of one type.
    fn is_pair(&self) -> bool {
        self.pair_type().is_some()
    }

    /// The type of both.
    fn pair_type(&self) -> Option<TypeId> {
        let params = self.function.params().iter().enumerate();
        let outs: Vec<_> = params.filter(|(index, _)| self.function.param_mode(*index) == ParamMode::Out).collect();
        match outs.as_slice() {
            [(_, a), (_, b)] if [a.name.as_str(), b.name.as_str()] == PAIR && a.ty == b.ty => Some(a.ty),
            _ => None,
        }
    }

    /// A function that returns one of the two results.
    fn returning(&self, name: &str, result: &str) -> String {
        let outs = self.function.params().iter().find(|param| param.name == result);
        let ty = outs.map_or_else(String::new, |param| self.types.name(param.ty));
        let (mut list, mut arguments) = (String::new(), String::new());
        for (index, param) in self.function.params().iter().enumerate() {
            let separate = |text: &mut String| text.push_str(if text.is_empty() { "" } else { ", " });
            separate(&mut arguments);
            if self.function.param_mode(index) == ParamMode::Out {
                arguments.push_str(&format!("glisten_{}", param.name));
                continue;
            }
            separate(&mut list);
            let _ = write!(list, "{} a{index}", self.types.name(param.ty));
            let _ = write!(arguments, "a{index}");
        }
        let [got, expected] = PAIR;
        format!(
            "\n{ty} {name}({list}) {{ {ty} glisten_{got}; {ty} glisten_{expected}; {}({arguments}); return glisten_{result}; }}",
            self.function.name
        )
    }
}

/// The line of a function, if it is in the file called `name`.
fn line_in(sources: &SourceMap, name: &str, function: &Function) -> Option<u32> {
    let location = sources.location(sources.call_site(function.span))?;
    (sources.file(location.file).name() == name).then_some(location.line)
}

/// The first error of a compilation, with its line in the source.
fn told(compilation: &Compilation, name: &str) -> String {
    let sources = &compilation.sources;
    let Some(error) = compilation.diagnostics.iter().find(|found| found.is_error()) else {
        return "the source does not compile".to_owned();
    };
    let place = sources.location(sources.call_site(error.primary.span)).map(|at| {
        let file = sources.file(at.file).name();
        if file == name { format!("line {}: ", at.line) } else { format!("{file}:{}: ", at.line) }
    });
    format!("{}{} ({})", place.unwrap_or_default(), error.message, error.code)
}

impl Reference {
    fn of(evaluator: &Evaluator, other: Option<&Evaluator>, rows: &[Vec<f64>]) -> Result<Self, EvaluateError> {
        let inputs = rows.concat();
        let picture = |evaluator: &Evaluator, precision| -> Result<Picture, EvaluateError> {
            let scene = evaluator.scene(&inputs, &[])?;
            let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
            render(&scene, &options).map_err(|errors| EvaluateError::told(&errors))
        };
        let intervals = |evaluator: &Evaluator| -> Result<Vec<Vec<Interval>>, EvaluateError> {
            Ok(evaluator.read_intervals(&picture(evaluator, Precision::Envelope)?, rows.len()))
        };
        Ok(Self {
            single: evaluator.read(&picture(evaluator, Precision::F32)?, rows.len()),
            envelope: intervals(evaluator)?,
            others: other.map(intervals).transpose()?.unwrap_or_default(),
        })
    }
}

impl UnitTest {
    /// How many cases the test has.
    pub fn cases(&self) -> usize {
        self.prepared.as_ref().map_or(0, |prepared| prepared.rows.len())
    }

    /// The scene that calls the function for every case, for who draws it by other means.
    pub fn scene(&self) -> Option<Scene> {
        let prepared = self.prepared.as_ref().ok()?;
        prepared.evaluator.scene(&prepared.rows.concat(), &[]).ok()
    }

    /// Runs the test on a backend, or on the reference.
    pub fn run(&self, backend: Option<&mut dyn TestBackend>) -> TestResult {
        let prepared = match &self.prepared {
            Ok(prepared) => prepared,
            Err(result) => return result.clone(),
        };
        let drawn = match backend {
            None => None,
            Some(backend) => {
                let scene = prepared.evaluator.scene(&prepared.rows.concat(), &[]);
                let scene = match scene {
                    Ok(scene) => scene,
                    Err(error) => return TestResult::Fail(error.to_string()),
                };
                match backend.draw(&scene) {
                    Ok(picture) => Some(prepared.evaluator.read(&picture, prepared.rows.len())),
                    Err(result) => return result,
                }
            }
        };
        prepared.compared(&self.name, drawn.as_ref().unwrap_or(&prepared.reference.single))
    }
}

impl Prepared {
    fn compared(&self, name: &str, results: &[Vec<f64>]) -> TestResult {
        let mut first = None;
        let mut failed = 0;
        for (number, (inputs, got)) in self.rows.iter().zip(results).enumerate() {
            let of = |all: &'_ [Vec<Interval>]| all.get(number).cloned().unwrap_or_default();
            let (envelope, others) = (of(&self.reference.envelope), of(&self.reference.others));
            let row = Row { inputs, scalar: self.scalar, got, envelope: &envelope, others: &others };
            let Some(fault) = fault(&self.expected, &row, number, self.tolerance) else { continue };
            failed += 1;
            if first.is_none() {
                let line = self.lines.get(number).copied().unwrap_or(0);
                let call = call(name, &self.parameters, row.inputs);
                let what = if self.other.is_some() { "`got` of " } else { "" };
                first = Some(format!("line {line}: {what}`{call}` {fault}"));
            }
        }
        match first {
            None => TestResult::Pass,
            Some(first) if failed == 1 && self.rows.len() == 1 => TestResult::Fail(first),
            Some(first) => TestResult::Fail(format!("{first} ({failed} of {} cases fail)", self.rows.len())),
        }
    }
}
