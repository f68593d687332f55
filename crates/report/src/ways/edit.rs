//! [`Edited`]: the stages of a draw's program, open for changes.
//!
//! *In:* a draw. *Out:* the draw with the changed program, which is printed as GLSL 1.50, read back and linked, so that
//! it is always a program that glisten accepts.
//!
//! *Holds:* functions that a change adds are prototypes in the typed program; their texts are appended to the printed
//! stage. Values of uniforms, textures and attributes stay by their names. A change that does not read back gives no
//! draw.

use glisten_emit::{Conventions, Target, emit};
use glisten_front::hir::{
    Expr, ExprId, ExprKind, Function, FunctionId, Local, LocalKind, ParamMode, Shader, Stage, TypeId, Types, all_names,
    fresh_name, print,
};
use glisten_front::source::Span;
use glisten_front::{Compiler, Options, Program, Source};
use glisten_scene::{Draw, Scene, Texture};
use glisten_verify::specialize::with_program;
use std::fmt::Write;
use std::sync::Arc;

/// Both stages of a program, and what is appended to their texts.
#[derive(Clone, Debug)]
pub(super) struct Edited {
    pub(super) types: Types,
    pub(super) vertex: Open,
    pub(super) fragment: Open,
    /// Textures for samplers that the appended texts declare.
    pub(super) textures: Vec<(String, Arc<Texture>)>,
}

/// A stage that is being changed.
#[derive(Clone, Debug)]
pub(super) struct Open {
    pub(super) shader: Shader,
    /// GLSL after the last function: the bodies of prototypes, and a new `main` if the old one was renamed.
    pub(super) appended: String,
}

impl Edited {
    /// The stages of a draw; `None` if it has a geometry stage, or lacks one of the two.
    pub(super) fn of(draw: &Draw) -> Option<Self> {
        let program = &draw.program;
        let open = |stage| {
            let mut shader = program.stage(stage)?.clone();
            shader.mark_static_use();
            Some(Open { shader, appended: String::new() })
        };
        let whole = program.stage(Stage::Geometry).is_none();
        let (vertex, fragment) = (open(Stage::Vertex)?, open(Stage::Fragment)?);
        whole.then(|| Self { types: program.types.clone(), vertex, fragment, textures: Vec::new() })
    }

    /// The draw with the changed stages.
    pub(super) fn draw(&self, draw: &Draw) -> Option<Draw> {
        let texts = [self.vertex.text(&self.types), self.fragment.text(&self.types)];
        let mut changed = rebuilt(draw, &texts)?;
        let slots: Vec<String> = changed.program.interface.samplers.iter().map(|slot| slot.name.clone()).collect();
        for (name, texture) in &self.textures {
            let place = slots.iter().position(|slot| slot == name)?;
            *changed.textures.get_mut(place)? = Some(Arc::clone(texture));
        }
        Some(changed)
    }
}

impl Open {
    /// The stage as text.
    pub(super) fn text(&self, types: &Types) -> String {
        let mut text = stage_text(types, &self.shader);
        text.push_str(&self.appended);
        text
    }

    /// A name that nothing in the stage has.
    pub(super) fn fresh(&self, types: &Types, wanted: &str) -> String {
        let taken = all_names(types, &self.shader);
        fresh_name(wanted, |name| taken.contains(name) || self.appended.contains(name))
    }

    /// Declares a function whose text is appended by the caller.
    pub(super) fn prototype(&mut self, name: &str, ret: TypeId, params: &[TypeId]) -> FunctionId {
        let span = Span::default();
        let local = |(index, ty): (usize, &TypeId)| Local {
            name: format!("p{index}"),
            ty: *ty,
            kind: LocalKind::Param(ParamMode::In),
            value: None,
            span,
        };
        let locals = params.iter().enumerate().map(local).collect();
        let function =
            Function { name: name.into(), ret, param_count: params.len(), locals, body: None, reachable: true, span };
        self.shader.functions.push(function);
        FunctionId::new(self.shader.functions.len() - 1)
    }

    /// Puts a call of `function` in the place of an expression.
    pub(super) fn replace(&mut self, id: ExprId, function: FunctionId, arguments: Vec<ExprId>) {
        if let Some(expr) = self.shader.exprs.get_mut(id.index()) {
            expr.kind = ExprKind::Call(function, arguments);
        }
    }

    /// Adds a copy of an expression, so that the original's place is free for something around it.
    pub(super) fn copied(&mut self, id: ExprId) -> ExprId {
        let Expr { kind, ty, span } = self.shader.expr(id).clone();
        self.shader.push(kind, ty, span)
    }

    /// Renames `main`, and gives its new name.
    pub(super) fn renamed_main(&mut self, types: &Types, wanted: &str) -> Option<String> {
        let name = self.fresh(types, wanted);
        let main = self.shader.main.take()?;
        self.shader.functions.get_mut(main.index())?.name.clone_from(&name);
        Some(name)
    }
}

/// A stage as GLSL 1.50.
pub(super) fn stage_text(types: &Types, shader: &Shader) -> String {
    let mut shader = shader.clone();
    shader.version.number = 150;
    print(types, &shader)
}

/// The draw with other texts for its vertex and its fragment stage; `None` if they do not compile.
pub(super) fn rebuilt(draw: &Draw, texts: &[String; 2]) -> Option<Draw> {
    let program = compiled(&draw.program, texts)?;
    Some(with_program(draw, Arc::new(program), &[]))
}

/// Compiles two stages with the locations that a program has.
fn compiled(like: &Program, [vertex, fragment]: &[String; 2]) -> Option<Program> {
    let source = |extension: &str, text: &String, stage| Source {
        name: format!("{}.{extension}", like.name),
        text: text.as_str().into(),
        stage,
    };
    let sources = [source("vert", vertex, Stage::Vertex), source("frag", fragment, Stage::Fragment)];
    let (attributes, outputs) = (&like.interface.attributes, &like.interface.outputs);
    let options = Options {
        attribute_locations: attributes.iter().map(|one| (one.name.clone(), one.location)).collect(),
        frag_data_locations: outputs.iter().map(|one| (one.name.clone(), one.location)).collect(),
        ..Options::default()
    };
    Compiler::new(options).compile(&sources).program
}

/// The scene with one draw replaced.
pub(super) fn with_draw(scene: &Scene, index: usize, draw: Draw) -> Option<Scene> {
    let mut scene = scene.clone();
    *scene.draws.get_mut(index)? = draw;
    Some(scene)
}

/// Whether two scenes of as many draws differ in anything that is drawn with: programs, uniforms, textures, vertices.
pub(crate) fn differs(a: &Scene, b: &Scene) -> bool {
    let text = |draw: &Draw| -> Vec<String> {
        draw.program.stages.iter().map(|shader| stage_text(&draw.program.types, shader)).collect()
    };
    a.draws.len() != b.draws.len()
        || a.draws.iter().zip(&b.draws).any(|(a, b)| {
            a.uniforms != b.uniforms
                || a.vertex_count != b.vertex_count
                || a.textures != b.textures
                || a.attributes != b.attributes
                || text(a) != text(b)
        })
}

/// Whether every program of a scene has a translation for the GPU.
pub(super) fn is_emitted(scene: &Scene) -> bool {
    let conventions = Conventions::default();
    let targets = [Target::Spirv, Target::Wgsl];
    scene.draws.iter().all(|draw| {
        draw.program
            .stages
            .iter()
            .all(|shader| targets.iter().all(|target| emit(&draw.program, shader.stage, *target, &conventions).is_ok()))
    })
}

/// The names of the parameters of functions that [`call`] declares.
const PARAMETERS: [&str; 3] = ["a", "b", "c"];

/// Puts a call of a function in the place of an expression: its name, the types of its parameters `a`, `b`, `c`, and the text
/// of its body. It is declared if it is not yet there.
pub(super) fn call(
    types: &Types,
    open: &mut Open,
    id: ExprId,
    (wanted, params, body): (&str, &[TypeId], &str),
    arguments: Vec<ExprId>,
) {
    let ret = open.shader.expr(id).ty;
    let known = open.shader.functions().find(|(_, function)| {
        let types = function.params().iter().map(|param| param.ty);
        function.body.is_none() && function.name == wanted && types.eq(params.iter().copied())
    });
    let function = match known.map(|(id, _)| id) {
        Some(id) => id,
        None => {
            let declared = open.shader.functions.iter().any(|one| one.body.is_none() && one.name == wanted);
            let name = if declared { wanted.to_owned() } else { open.fresh(types, wanted) };
            let list: Vec<String> =
                params.iter().zip(PARAMETERS).map(|(ty, name)| format!("{} {name}", types.name(*ty))).collect();
            let head = format!("{} {name}({})", types.name(ret), list.join(", "));
            let _ = write!(open.appended, "\n{head} {{\n    {body}\n}}\n");
            open.prototype(&name, ret, params)
        }
    };
    open.replace(id, function, arguments);
}
