//! Generates the program around a function: it reads the inputs from a texture, calls the function, and writes the
//! results.
//!
//! *In:* a text and a signature. *Out:* the text of a fragment shader, and the number of inputs and results.

use super::EvaluateError;
use glisten_front::diagnostic::did_you_mean;
use glisten_front::hir::{ArraySize, Function, ParamMode, SamplerDim, Scalar, Shader, Stage, Type, TypeId, Types};
use glisten_front::{Compiler, Source};

/// A triangle that covers the whole window.
const VERTEX: &str = "void main()\n{\n    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, \
    gl_VertexID == 2 ? 3.0 : -1.0);\n    gl_Position = vec4(p, 0.0, 1.0);\n}\n";
/// The prefix of the names of the table uniforms; a number follows.
pub(super) const TABLE: &str = "glisten_table";

/// The name of the texture with the inputs.
pub(super) const INPUTS: &str = "glisten_inputs";
/// The name of the output with the results.
pub(super) const RESULT: &str = "glisten_result";

/// A text with functions.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    /// The name of its file, next to which its includes are.
    pub name: &'a str,
    /// Its version: what follows `#version`.
    pub version: &'a str,
    /// The text, without a `#version` line and without `main`.
    pub text: &'a str,
}

impl<'a> Text<'a> {
    /// A text of GLSL 1.50 without a file.
    pub fn new(text: &'a str) -> Self {
        Self { name: "evaluate.frag", version: "150", text }
    }
}

/// The vertex shader of a version.
pub(super) fn vertex(version: &str) -> String {
    format!("#version {version}\n{VERTEX}")
}

/// The text of a call.
pub(super) struct Call {
    pub(super) text: String,
    /// The numbers of a row of inputs: whether each is an integer, which takes two floats.
    pub(super) inputs: Vec<bool>,
    pub(super) results: usize,
    /// Whether the results are integers, each of which takes [`FLOATS_A_WHOLE`] floats.
    pub(super) is_whole: bool,
    pub(super) tables: usize,
}

/// A float has 24 bits, so an integer of 32 is passed as its upper and its lower half.
pub(super) const HALF: f64 = 65_536.0;
/// The floats of an integer that is a result: the nearest float, whose interval is that of the integer, and both halves.
pub(super) const FLOATS_A_WHOLE: usize = 3;

fn head(Text { version, text, .. }: Text<'_>) -> String {
    format!("#version {version}\n#extension GL_ARB_shading_language_include : enable\n{text}\n")
}

/// A shader with the text and an empty `main`.
fn whole(text: Text<'_>) -> Source {
    let whole = head(text) + "out vec4 glisten_result;\nvoid main() { glisten_result = vec4(0.0); }\n";
    Source { name: text.name.into(), text: whole.into(), stage: Stage::Fragment }
}

/// The signatures of all functions that a text defines, including those of its includes, in order:
/// `lerp(float,float,float)`.
///
/// # Errors
/// The text does not compile.
pub fn signatures(compiler: &Compiler, text: &str) -> Result<Vec<String>, EvaluateError> {
    let (types, shader) = compile(compiler, Text::new(text))?;
    let defined = shader.functions.iter().filter(|function| function.body.is_some() && function.name != "main");
    Ok(defined.map(|function| signature_of(&types, function)).collect())
}

pub(crate) fn signature_of(types: &Types, function: &Function) -> String {
    let names: Vec<String> = function.params().iter().map(|param| types.name(param.ty)).collect();
    format!("{}({})", function.name, names.join(","))
}

fn compile(compiler: &Compiler, text: Text<'_>) -> Result<(Types, Shader), EvaluateError> {
    let compilation = compiler.compile(&[whole(text)]);
    let program = compilation.program.ok_or_else(|| EvaluateError::told(compilation.diagnostics.iter()))?;
    let mut stages = program.stages.into_iter();
    let shader = stages.next().ok_or_else(|| EvaluateError::new("there is no shader"))?;
    Ok((program.types, shader))
}

impl Call {
    pub(super) fn new(
        compiler: &Compiler,
        text: Text<'_>,
        signature: &str,
        wraps: &[(usize, &str)],
    ) -> Result<Self, EvaluateError> {
        let (types, shader) = compile(compiler, text)?;
        let wanted = signature.replace(' ', "");
        let found = shader.functions.iter().find(|f| f.body.is_some() && signature_of(&types, f) == wanted);
        let Some(function) = found else { return Err(unknown(&types, &shader, &wanted)) };
        let mut writer = Writer { types: &types, inputs: Vec::new(), floats: 0, tables: 0 };
        let arguments = writer.arguments(function, wraps)?;
        let (results, is_whole) = results(&types, function)?;
        Ok(Self {
            text: writer.text(text, function, &arguments, results, is_whole),
            inputs: writer.inputs,
            results,
            is_whole,
            tables: writer.tables,
        })
    }
}

fn unknown(types: &Types, shader: &Shader, wanted: &str) -> EvaluateError {
    let all: Vec<String> = shader.functions.iter().map(|function| signature_of(types, function)).collect();
    let near = did_you_mean(wanted, all.iter().map(String::as_str)).map(|near| format!("; did you mean `{near}`?"));
    EvaluateError::new(format!("there is no function `{wanted}`{}", near.unwrap_or_default()))
}

/// How many numbers a result has, and whether they are integers.
fn results(types: &Types, function: &Function) -> Result<(usize, bool), EvaluateError> {
    let size = types.flat_len(function.ret) as usize;
    match types.get(function.ret) {
        Type::Scalar(scalar) | Type::Vector(scalar, _) => Ok((size, scalar.is_integer())),
        Type::Matrix(..) => Ok((size, false)),
        _ => Err(EvaluateError::new(format!("`{}` returns `{}`", function.name, types.name(function.ret)))),
    }
}

struct Writer<'a> {
    types: &'a Types,
    /// [`Call::inputs`], as far as they are written.
    inputs: Vec<bool>,
    /// The floats that they take.
    floats: usize,
    tables: usize,
}

impl Writer<'_> {
    fn arguments(&mut self, function: &Function, wraps: &[(usize, &str)]) -> Result<Vec<String>, EvaluateError> {
        let mut arguments = Vec::new();
        let mut place = 0;
        for (index, param) in function.params().iter().enumerate() {
            if !matches!(function.param_mode(index), ParamMode::In | ParamMode::ConstIn) {
                return Err(EvaluateError::new(format!("parameter `{}` is not passed in alone", param.name)));
            }
            if let Type::Sampler(sampler) = self.types.get(param.ty) {
                if sampler.dim != SamplerDim::D2 || sampler.texel != Scalar::Float || sampler.arrayed || sampler.shadow
                {
                    return Err(self.unfit(param.ty));
                }
                arguments.push(format!("{TABLE}{}", self.tables));
                self.tables += 1;
                continue;
            }
            let value = self.value(param.ty)?;
            let wrap = wraps.iter().find(|(wrapped, _)| *wrapped == place);
            arguments.push(wrap.map_or(value.clone(), |(_, name)| format!("{name}({value})")));
            place += 1;
        }
        Ok(arguments)
    }

    fn unfit(&self, ty: TypeId) -> EvaluateError {
        EvaluateError::new(format!("a parameter of type `{}` cannot be filled from numbers", self.types.name(ty)))
    }

    /// The next component of the inputs, as a `scalar`.
    fn next(&mut self, scalar: Scalar) -> String {
        let mut float = || {
            let index = self.floats;
            self.floats += 1;
            format!("x{}[{}]", index / 4, index % 4)
        };
        let number = match scalar {
            Scalar::Float => float(),
            Scalar::Bool => format!("({} != 0.0)", float()),
            Scalar::Int => format!("(int({}) * 65536 + int({}))", float(), float()),
            Scalar::Uint => format!("(uint({}) * 65536u + uint({}))", float(), float()),
        };
        self.inputs.push(scalar.is_integer());
        number
    }

    /// A constructor of the type from the inputs that follow.
    fn value(&mut self, ty: TypeId) -> Result<String, EvaluateError> {
        match self.types.get(ty) {
            Type::Scalar(scalar) => Ok(self.next(scalar)),
            Type::Vector(..) | Type::Matrix(..) => {
                let scalar = self.types.scalar_of(ty).unwrap_or(Scalar::Float);
                let numbers: Vec<String> = (0..self.types.flat_len(ty)).map(|_| self.next(scalar)).collect();
                Ok(format!("{}({})", self.types.name(ty), numbers.join(", ")))
            }
            Type::Struct(id) => {
                let members: Vec<TypeId> = self.types.structure(id).members.iter().map(|member| member.ty).collect();
                self.list(ty, &members)
            }
            Type::Array(element, ArraySize::Sized(size)) => self.list(ty, &vec![element; size as usize]),
            _ => Err(self.unfit(ty)),
        }
    }

    fn list(&mut self, ty: TypeId, parts: &[TypeId]) -> Result<String, EvaluateError> {
        let parts: Result<Vec<String>, EvaluateError> = parts.iter().map(|part| self.value(*part)).collect();
        Ok(format!("{}({})", self.types.name(ty), parts?.join(", ")))
    }

    fn text(
        &self,
        text: Text<'_>,
        function: &Function,
        arguments: &[String],
        results: usize,
        is_whole: bool,
    ) -> String {
        let mut out = head(text);
        out += "uniform sampler2D glisten_inputs;\n";
        (0..self.tables).for_each(|index| out += &format!("uniform sampler2D {TABLE}{index};\n"));
        out += "out vec4 glisten_result;\nvoid main()\n{\n    ivec2 at = ivec2(gl_FragCoord.xy);\n";
        let floats = if is_whole { results * FLOATS_A_WHOLE } else { results };
        let (parts, texels) = (floats.div_ceil(4), self.floats.div_ceil(4));
        out += &format!("    int row = at.x / {parts};\n");
        for index in 0..texels {
            out +=
                &format!("    vec4 x{index} = texelFetch(glisten_inputs, ivec2(row * {texels} + {index}, at.y), 0);\n");
        }
        let ret = self.types.name(function.ret);
        out += &format!("    {ret} y = {}({});\n", function.name, arguments.join(", "));
        let value = |index: usize| match self.types.get(function.ret) {
            Type::Scalar(_) => "y".to_owned(),
            Type::Matrix(_, rows) => format!("y[{}][{}]", index / usize::from(rows), index % usize::from(rows)),
            _ => format!("y[{index}]"),
        };
        let lower = if self.types.scalar_of(function.ret) == Some(Scalar::Uint) { "65535u" } else { "65535" };
        let component = |index: usize| match (is_whole, index % FLOATS_A_WHOLE) {
            _ if index >= floats => "0.0".to_owned(),
            (false, _) => format!("float({})", value(index)),
            (true, 0) => format!("float({})", value(index / FLOATS_A_WHOLE)),
            (true, 1) => format!("float({} >> 16)", value(index / FLOATS_A_WHOLE)),
            (true, _) => format!("float({} & {lower})", value(index / FLOATS_A_WHOLE)),
        };
        for part in 0..parts {
            let numbers: Vec<String> = (0..4).map(|index| component(part * 4 + index)).collect();
            out += &format!(
                "    if (at.x - row * {parts} == {part})\n        glisten_result = vec4({});\n",
                numbers.join(", ")
            );
        }
        out + "}\n"
    }
}
