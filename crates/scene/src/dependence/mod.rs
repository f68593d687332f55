//! [`ColorDependence`]: whether the color of a fragment depends on anything that differs between fragments.
//!
//! *In:* a linked program. *Out:* whether the color and the alpha may differ from pixel to pixel; whether an expression depends on some
//! variables. *Holds:* what is told as equal is equal,
//! whatever the uniforms, textures and vertices are, on one face of one instance; what is told as different may still be equal (a
//! factor of 0). Stages pass what differs to the next by the names of their varyings; of a texture only the coordinates count.

mod stage;

use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{ExprId, FunctionId, Global, GlobalId, Shader, Stage, StmtKind, Storage, Type};
use glisten_front::link::Program;
use stage::{Differing, differing, expression_differs};
use std::collections::BTreeSet;

/// The parts of a color that may differ between fragments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColorDependence {
    /// Red, green or blue.
    pub color: bool,
    /// The fourth component.
    pub alpha: bool,
    /// Whether a color is written at all.
    pub written: bool,
    /// Whether pixels can be covered: a position is written, and not every fragment is discarded.
    pub covers: bool,
}

/// The variables of which the fixed-function pipeline's fragment stage makes a color.
const FIXED_COLORS: [&str; 2] = ["gl_FrontColor", "gl_TexCoord"];

impl ColorDependence {
    /// The dependence of a program's colors.
    pub fn of(program: &Program) -> Self {
        let mut passed: Option<BTreeSet<String>> = None;
        for shader in program.stages.iter().filter(|shader| shader.stage != Stage::Fragment) {
            let starts = |global: &Global| starts(global, shader.stage, passed.as_ref());
            let found = differing(&program.types, shader, shader.globals.iter().map(starts).collect());
            // Each vertex that a geometry stage emits may have other values, also constant ones.
            let is_passed = |index: usize, global: &Global| {
                global.storage == Storage::Out && (shader.stage == Stage::Geometry || found.has(index))
            };
            let outputs = shader.globals.iter().enumerate().filter(|(index, global)| is_passed(*index, global));
            passed = Some(outputs.map(|(_, global)| global.match_name().to_owned()).collect());
        }
        let covers = is_placed(program) && !program.stage(Stage::Fragment).is_some_and(discards);
        let Some(fragment) = program.stage(Stage::Fragment) else {
            let has = |name: &&str| passed.as_ref().is_some_and(|passed| passed.contains(*name));
            let color = FIXED_COLORS.iter().any(has);
            return Self { color, alpha: color, written: true, covers };
        };
        let starts = fragment.globals.iter().map(|global| starts(global, Stage::Fragment, passed.as_ref()));
        let found = differing(&program.types, fragment, starts.collect());
        let is_color = |global: &Global| global.storage == Storage::Out && !is_other_output(global);
        let outputs = fragment.globals.iter().enumerate().filter(|(_, global)| is_color(global) && global.written);
        outputs.fold(Self { covers, ..Self::default() }, |known, (index, _)| Self {
            color: known.color || found.has(index),
            alpha: known.alpha || found.has_alpha(index),
            written: true,
            covers,
        })
    }
}

/// Whether an expression of the fragment stage may depend on some globals of the stages, also by what the stages before pass on.
pub fn depends_on(program: &Program, meant: &BTreeSet<(Stage, GlobalId)>, place: (FunctionId, ExprId)) -> bool {
    let mut passed: BTreeSet<&str> = BTreeSet::new();
    for shader in &program.stages {
        let starts = |(id, global): (GlobalId, &Global)| {
            meant.contains(&(shader.stage, id)) || global.storage == Storage::In && passed.contains(global.match_name())
        };
        let starts: Vec<bool> = shader.globals().map(starts).collect();
        if shader.stage == Stage::Fragment {
            return expression_differs(&program.types, shader, starts, place);
        }
        let found = differing(&program.types, shader, starts);
        let outputs = shader
            .globals
            .iter()
            .enumerate()
            .filter(|(index, global)| global.storage == Storage::Out && found.has_alpha(*index));
        passed = outputs.map(|(_, global)| global.match_name()).collect();
    }
    false
}

/// Whether the stage before the fragments writes `gl_Position`.
fn is_placed(program: &Program) -> bool {
    let last = program.stages.iter().rev().find(|shader| shader.stage != Stage::Fragment);
    let is_position = |global: &Global| global.storage == Storage::Out && has_position(program, global);
    last.is_none_or(|shader| shader.globals.iter().any(|global| is_position(global) && global.written))
}

/// Whether a global is `gl_Position`, or the block that contains it.
fn has_position(program: &Program, global: &Global) -> bool {
    let members = match program.types.get(global.ty) {
        Type::Struct(id) if global.block.is_some() => program.types.structure(id).members.as_slice(),
        _ => &[],
    };
    global.builtin == Some(BuiltinVariable::Position) || members.iter().any(|member| member.name == "gl_Position")
}

/// Whether `main` discards each fragment.
fn discards(shader: &Shader) -> bool {
    let body = shader.main.and_then(|main| shader.function(main).body.as_deref()).unwrap_or_default();
    body.iter().any(|statement| matches!(statement.kind, StmtKind::Discard))
}

/// Whether an output of the fragment stage is no color.
fn is_other_output(global: &Global) -> bool {
    global.builtin == Some(BuiltinVariable::FragDepth)
}

/// Whether an input differs between the invocations of a stage, by what the stage before passes; `None`: the pipeline's own stage, or the
/// attributes.
fn starts(global: &Global, stage: Stage, passed: Option<&BTreeSet<String>>) -> bool {
    let is_own = global.builtin.is_some() || stage != Stage::Fragment;
    // Which face or instance it is says nothing about the place on it.
    let of_all = matches!(global.builtin, Some(BuiltinVariable::FrontFacing | BuiltinVariable::InstanceId));
    let is_input = global.storage == Storage::In && !of_all;
    is_input && (is_own || passed.is_none_or(|passed| passed.contains(global.match_name())))
}

impl Differing {
    fn has(&self, index: usize) -> bool {
        self.globals.get(index) == Some(&true)
    }

    fn has_alpha(&self, index: usize) -> bool {
        self.alphas.get(index) == Some(&true) || self.has(index)
    }
}

#[cfg(test)]
mod tests {
    use super::ColorDependence;
    use glisten_front::hir::Stage;
    use glisten_front::{Compiler, Options, Source};

    fn told(vertex: &str, fragment: &str) -> (bool, bool, bool) {
        let source = |name: &str, stage, text: &str| Source { name: name.to_owned(), text: text.into(), stage };
        let sources = [source("a.vert", Stage::Vertex, vertex), source("a.frag", Stage::Fragment, fragment)];
        let compilation = Compiler::new(Options::default()).compile(&sources);
        let program = compilation.program.expect("a program");
        let ColorDependence { color, alpha, written, .. } = ColorDependence::of(&program);
        (color, alpha, written)
    }

    const VERTEX: &str = "attribute vec3 p;\nuniform vec4 tint;\nvarying vec4 c, same;\nvoid main() { c = vec4(p, 1.0); same = tint; \
        gl_Position = vec4(p, 1.0); }\n";

    #[test]
    fn colors_depend_through_data_and_control() {
        for body in [
            "gl_FragColor = c;",
            "gl_FragColor = vec4(gl_FragCoord.x * 0.01);",
            "vec4 r = vec4(0.0); if (c.x > 0.5) r = vec4(1.0); gl_FragColor = r;",
            "vec4 r = vec4(0.0); for (int i = 0; float(i) < c.x; i++) r += 0.1; gl_FragColor = r;",
            "gl_FragColor = f(c.x);",
            "gl_FragColor = same; if (c.x > 0.5) return; gl_FragColor = vec4(1.0);",
            "gl_FragColor = texture2D(t, c.xy);",
            "vec4 r; g(c.x, r); gl_FragColor = r;",
            "gl_FragColor = c.x > 0.5 ? same : vec4(1.0);",
            "shared_value = c.x; gl_FragColor = h();",
        ] {
            let fragment = format!("{DECLARED}void main() {{ {body} }}\n");
            assert_eq!(told(VERTEX, &fragment), (true, true, true), "{body}");
        }
    }

    #[test]
    fn colors_that_no_input_reaches() {
        for (body, expected) in [
            ("gl_FragColor = vec4(1.0, 0.0, 0.0, 1.0);", (false, false, true)),
            ("gl_FragColor = same * tint2;", (false, false, true)),
            ("if (c.x > 0.5) discard; gl_FragColor = same;", (false, false, true)),
            ("gl_FragColor = texture2D(t, tint2.xy);", (false, false, true)),
            ("gl_FragColor = f(0.5);", (false, false, true)),
            ("gl_FragColor = gl_FrontFacing ? same : tint2;", (false, false, true)),
            ("gl_FragColor = vec4(same.rgb, c.x);", (false, true, true)),
            ("gl_FragColor = same; gl_FragColor.a = c.x;", (false, true, true)),
            ("gl_FragDepth = c.x;", (false, false, false)),
            ("", (false, false, false)),
        ] {
            let fragment = format!("{DECLARED}void main() {{ {body} }}\n");
            assert_eq!(told(VERTEX, &fragment), expected, "{body}");
        }
    }

    #[test]
    fn what_covers_nothing() {
        let covers = |vertex: &str, body: &str| {
            let source = |name: &str, stage, text: &str| Source { name: name.to_owned(), text: text.into(), stage };
            let fragment = format!("{DECLARED}void main() {{ {body} }}\n");
            let sources = [source("a.vert", Stage::Vertex, vertex), source("a.frag", Stage::Fragment, &fragment)];
            let program = Compiler::new(Options::default()).compile(&sources).program.expect("a program");
            ColorDependence::of(&program).covers
        };
        assert!(covers(VERTEX, "if (c.x > 0.5) discard; gl_FragColor = same;"));
        assert!(!covers(VERTEX, "gl_FragColor = same; discard;"));
        assert!(!covers(&VERTEX.replace("gl_Position = vec4(p, 1.0);", ""), "gl_FragColor = same;"));
    }

    const DECLARED: &str = "#version 110\nvarying vec4 c, same;\nuniform vec4 tint2;\nuniform sampler2D t;\nfloat shared_value;\n\
        vec4 f(float x) { if (x > 0.5) return vec4(1.0); return vec4(0.0); }\n\
        void g(float x, out vec4 r) { r = vec4(x); }\nvec4 h() { return vec4(shared_value); }\n";
}
