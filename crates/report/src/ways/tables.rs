//! Functions of one number by tables: textures of 16 to 1,024 texels in the place of what costs more.
//!
//! *In:* a scene and one of its draws. *Out:* the scene whose fragment stage looks up what depends on one number alone: the
//! power of a cosine, say. *Holds:* texel i of n has the function at the i-th of n numbers spread evenly over the range that
//! the number has in the picture; the reference computes both in f64. The lookup is exact at the centers of the texels.

use super::depends::{Tabulated, tabulated};
use super::edit::{Edited, rebuilt, with_draw};
use super::fixed::{Fixed, Place};
use super::names::Names;
use super::powers::decimal;
use super::probe;
use super::same::form;
use glisten_front::hir::{
    ConstructKind, Expr, ExprId, ExprKind, Function, FunctionId, GlobalId, Local, LocalId, LocalKind, ParamMode,
    Sampling, ScalarValue, Shader, Stage, Stmt, StmtKind, Storage, TypeId, VarRef,
};
use glisten_front::source::Span;
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::dynamic::{names_sampler, names_uniform};
use glisten_scene::{Draw, Filter, Format, Framebuffer, Scene, State, depends_on};
use glisten_verify::evaluate::table;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;

/// A draw gets so many tables.
const MOST_TABLES: usize = 4;
/// The parts of a function.
const MOST_PARTS: usize = 2048;
/// A number with a smaller range needs no table.
const LEAST_RANGE: f64 = 1e-4;

/// A function that a table can take the place of.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// Its places in the fragment stage, each with its argument.
    places: Vec<(ExprId, ExprId)>,
    /// The fragment stage that writes its values, for a range and a number of texels.
    source: String,
    /// The range of its argument over the picture.
    pub(super) range: [f64; 2],
    ty: TypeId,
}

/// The functions of one number of a draw that a picture needs, costliest first.
pub(super) fn candidates(scene: &Scene, index: usize) -> Vec<Candidate> {
    let Some(draw) = scene.draws.get(index) else { return Vec::new() };
    let Some(shader) = draw.program.stage(Stage::Fragment) else { return Vec::new() };
    let fixed = Fixed::of(draw, &scene.framebuffer, Stage::Fragment);
    let dynamic = dynamic(draw);
    let mut list: Vec<Candidate> = Vec::new();
    for found in tabulated(&draw.program.types, shader, &fixed) {
        if list.len() == MOST_TABLES {
            break;
        }
        // In another frame, its range is another one.
        if depends_on(&draw.program, &dynamic, (found.function, found.argument)) {
            continue;
        }
        let Some(source) = source(draw, &fixed, &found) else { continue };
        let Some(range) = probe::range(scene, index, found.argument) else { continue };
        let place = (found.expr, found.argument);
        let same = list.iter_mut().find(|known| known.source == source);
        if let Some(known) = same {
            known.places.push(place);
            known.range = [known.range[0].min(range[0]), known.range[1].max(range[1])];
        } else if range[1] - range[0] > LEAST_RANGE {
            let ty = shader.expr(found.expr).ty;
            list.push(Candidate { places: vec![place], source, range, ty });
        }
    }
    list
}

/// The uniforms and samplers of a draw that are `dynamic`, in each stage.
fn dynamic(draw: &Draw) -> BTreeSet<(Stage, GlobalId)> {
    let interface = &draw.program.interface;
    let any = |is_it: &dyn Fn(&str) -> bool| draw.dynamic.iter().any(|name| is_it(name));
    let leaves = interface.uniforms.iter().filter(|leaf| any(&|name| names_uniform(interface, name, leaf)));
    let roots = leaves.filter_map(|leaf| interface.roots.get(leaf.root.0 as usize)).flat_map(|root| &root.globals);
    let samplers = interface.samplers.iter().filter(|slot| any(&|name| names_sampler(name, &slot.name)));
    roots.chain(samplers.flat_map(|slot| &slot.globals)).copied().collect()
}

/// The scene with tables of so many texels.
pub(super) fn by_tables(
    scene: &Scene,
    index: usize,
    candidates: &[Candidate],
    texels: u32,
    filter: Filter,
) -> Option<Scene> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let types = edited.types.clone();
    for candidate in candidates {
        let values = values(draw, candidate, texels)?;
        let stage = &mut edited.fragment;
        let (name, function) = (stage.fresh(&types, "table"), stage.fresh(&types, "look_up"));
        let ty = types.name(candidate.ty);
        let [scale, offset] = coordinate(candidate.range, texels);
        let parts = [".r", ".rg", ".rgb", ""].get(types.flat_len(candidate.ty) as usize - 1).copied().unwrap_or("");
        let _ = write!(
            stage.appended,
            "\nuniform sampler2D {name};\n\n{ty} {function}(float x) {{\n    \
             return textureLod({name}, vec2(x * {} + {}, 0.5), 0.0){parts};\n}}\n",
            decimal(scale),
            decimal(offset)
        );
        let callee = stage.prototype(&function, candidate.ty, &[TypeId::FLOAT]);
        for (place, argument) in &candidate.places {
            let argument = stage.copied(*argument);
            stage.replace(*place, callee, vec![argument]);
        }
        edited.textures.push((name, Arc::new(table(values, filter))));
    }
    with_draw(scene, index, edited.draw(draw)?)
}

/// The factor and the summand that make a number the coordinate of its texel: the ends of the range are the centers of the
/// outer texels.
fn coordinate([low, high]: [f64; 2], texels: u32) -> [f64; 2] {
    let n = f64::from(texels);
    let scale = (n - 1.0) / (n * (high - low));
    [scale, 0.5 / n - low * scale]
}

/// The texels: the values of the function over the range.
fn values(draw: &Draw, candidate: &Candidate, texels: u32) -> Option<Vec<[f32; 4]>> {
    let [low, high] = candidate.range;
    let numbers = [low, high - low].map(|number| format!("{number:.17}"));
    let fragment = candidate
        .source
        .replace("RANGE_LOW", &numbers[0])
        .replace("RANGE_WIDTH", &numbers[1])
        .replace("LAST_TEXEL", &format!("{}.0", texels - 1));
    let mut filler = rebuilt(draw, &[WHOLE.to_owned(), fragment])?;
    (filler.state, filler.vertex_count, filler.instances, filler.indices) = (State::INITIAL, 3, 1, None);
    filler.attributes.clear();
    let framebuffer = Framebuffer {
        width: texels,
        height: 1,
        clear: [0.0; 4],
        format: Format::Rgba32Float,
        attachments: 1,
        encode: glisten_scene::picture::Encoding::default(),
    };
    let scene = Scene { name: "table".into(), framebuffer, draws: vec![filler] };
    let options = RenderOptions { precision: Precision::F64, mark_edges: false, ..RenderOptions::default() };
    let picture = render(&scene, &options).ok()?;
    let values = picture.attachments.first()?;
    let finite = values.iter().flatten().all(|value| value.is_finite());
    finite.then(|| values.iter().map(|texel| texel.map(|value| value as f32)).collect())
}

/// A triangle over the whole picture.
const WHOLE: &str = "#version 150
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
";

/// A fragment stage that writes a function's values, with `RANGE_LOW`, `RANGE_WIDTH` and `LAST_TEXEL` in the place of numbers.
fn source(draw: &Draw, fixed: &Fixed, found: &Tabulated) -> Option<String> {
    let mut edited = Edited::of(draw)?;
    let types = edited.types.clone();
    let stage = &mut edited.fragment;
    let (function, output) = (stage.fresh(&types, "tabulated"), stage.fresh(&types, "texel"));
    let original = stage.shader.clone();
    let names = Names::of(&original);
    let at = Place { types: &types, shader: &original, names: &names };
    let mut copy = Copy { at, fixed, found, shader: &mut stage.shader, parts: 0 };
    let value = copy.of(found.expr)?;
    let ty = original.expr(found.expr).ty;
    let main = stage.shader.main.take()?;
    stage.shader.functions.get_mut(main.index())?.body = None;
    // Only the functions that it calls are left: the others may read what there is none of.
    keep_called(&mut stage.shader, value);
    stage.shader.functions.push(returning(&function, ty, value));
    let unused = stage.fresh(&types, "unused");
    for (number, global) in stage.shader.globals.iter_mut().enumerate() {
        if matches!(global.storage, Storage::In | Storage::Out) {
            if global.builtin.take().is_some() {
                global.name = format!("{unused}_{number}");
            }
            global.storage = Storage::Private;
            (global.location, global.index, global.interpolation_written) = (None, None, false);
            (global.sampling, global.invariant, global.block) = (Sampling::Center, false, None);
        }
    }
    let zeros = ["", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""].get(types.flat_len(ty) as usize)?;
    let _ = write!(
        stage.appended,
        "\nout vec4 {output};\n\nvoid main() {{\n    \
         float t = (gl_FragCoord.x - 0.5) / LAST_TEXEL;\n    \
         {output} = vec4({function}(RANGE_LOW + t * RANGE_WIDTH){zeros});\n}}\n"
    );
    Some(stage.text(&types))
}

/// Takes the bodies of functions away that an expression does not call.
fn keep_called(shader: &mut Shader, value: ExprId) {
    let mut called = Vec::new();
    shader.visit_expr(value, &mut |part| {
        if let ExprKind::Call(callee, _) = shader.expr(part).kind {
            called.extend(shader.callees_first(callee));
        }
    });
    for (index, function) in shader.functions.iter_mut().enumerate() {
        if !called.contains(&FunctionId::new(index)) {
            function.body = None;
        }
    }
}

/// `ty name(float x) { return value; }`
fn returning(name: &str, ty: TypeId, value: ExprId) -> Function {
    let span = Span::default();
    let x = Local { name: "x".into(), ty: TypeId::FLOAT, kind: LocalKind::Param(ParamMode::In), value: None, span };
    let body = vec![Stmt { kind: StmtKind::Return(Some(value)), span }];
    Function { name: name.into(), ret: ty, param_count: 1, locals: vec![x], body: Some(body), reachable: true, span }
}

/// Copies an expression, with the argument of the function for the scalar, and numbers for what is fixed.
struct Copy<'a> {
    at: Place<'a>,
    fixed: &'a Fixed,
    found: &'a Tabulated,
    shader: &'a mut Shader,
    parts: usize,
}

impl Copy<'_> {
    fn of(&mut self, id: ExprId) -> Option<ExprId> {
        self.parts += 1;
        (self.parts <= MOST_PARTS).then_some(())?;
        let (from, function) = (self.at.shader, self.found.function);
        let Expr { kind, ty, span } = from.expr(id).clone();
        if ty == TypeId::FLOAT && form(from, id, None) == self.found.key {
            return Some(self.shader.push(ExprKind::Var(VarRef::Local(LocalId::new(0))), ty, span));
        }
        if let ExprKind::Var(VarRef::Local(local)) = kind {
            return match self.fixed.value(&self.at, function, id) {
                Some(values) => self.literal(ty, &values),
                None => {
                    let (within, value) = self.at.names.get(function, local)?;
                    if within == function { self.of(value) } else { None }
                }
            };
        }
        if matches!(kind, ExprKind::Error | ExprKind::Assign(..) | ExprKind::IncDec(..) | ExprKind::Comma(..)) {
            return None;
        }
        let mut kind = kind;
        let mut is_whole = true;
        kind.for_each_operand(&mut |id| match is_whole.then(|| self.of(*id)).flatten() {
            Some(new) => *id = new,
            None => is_whole = false,
        });
        is_whole.then(|| self.shader.push(kind, ty, span))
    }

    /// Floats as literals.
    fn literal(&mut self, ty: TypeId, values: &[f64]) -> Option<ExprId> {
        let scalar = self.at.types.scalar_of(ty)?;
        let span = Span::default();
        let element = TypeId::vector(scalar, 1);
        let literals: Vec<ExprId> = values
            .iter()
            .map(|value| {
                use glisten_front::hir::Scalar;
                let value = match scalar {
                    Scalar::Bool => ScalarValue::Bool(*value != 0.0),
                    Scalar::Int => ScalarValue::Int(*value as i32),
                    Scalar::Uint => ScalarValue::Uint(*value as u32),
                    Scalar::Float => ScalarValue::Float(*value as f32),
                };
                self.shader.push(ExprKind::Literal(value), element, span)
            })
            .collect();
        match literals.as_slice() {
            [one] => Some(*one),
            _ => Some(self.shader.push(ExprKind::Construct(ConstructKind::Compose, literals), ty, span)),
        }
    }
}
