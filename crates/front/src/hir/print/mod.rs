//! The typed program as readable GLSL 1.50.
//!
//! *In:* a [`Shader`] without errors and its [`Types`]. *Out:* one text that means the same: every implicit conversion is
//! written out, every array has its size, every name is used for one thing in a function. Structs come first, then globals
//! in their order, then functions, callees before callers, so that no prototypes are needed.
//!
//! *Holds:* reading the text again and printing it gives the same text.

mod declarations;
mod expressions;
mod names;
mod statements;

use super::{Function, FunctionId, Shader, Type, TypeId, Types};
use names::NameTable;

/// Prints a shader.
pub fn print(types: &Types, shader: &Shader) -> String {
    shader.on_stack(|| {
        let names = NameTable::new(types, shader);
        let mut printer = Printer { types, shader, names, function: None, text: String::new(), indent: 0 };
        printer.shader();
        printer.text
    })
}

/// The state of a print.
struct Printer<'a> {
    types: &'a Types,
    shader: &'a Shader,
    names: NameTable,
    /// The function that is being printed.
    function: Option<FunctionId>,
    text: String,
    indent: usize,
}

impl Printer<'_> {
    fn shader(&mut self) {
        self.header();
        self.structs();
        self.early_prototypes();
        self.globals();
        for id in self.function_order() {
            self.function(id);
        }
    }

    fn line(&mut self, line: &str) {
        for _ in 0..self.indent {
            self.text.push_str("    ");
        }
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn blank(&mut self) {
        if !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    /// A type as it stands before a name: `float[3]`.
    fn type_name(&self, ty: TypeId) -> String {
        match self.types.get(ty) {
            Type::Struct(id) => self.names.structure(id).to_owned(),
            Type::Array(element, size) => {
                let dim = match size {
                    super::ArraySize::Sized(size) => format!("[{size}]"),
                    super::ArraySize::Unsized => "[]".into(),
                };
                format!("{}{dim}", self.type_name(element))
            }
            _ => self.types.name(ty),
        }
    }

    /// Callees before callers: first what `main` needs, then the rest in their order.
    fn function_order(&self) -> Vec<FunctionId> {
        let roots = self.shader.main.into_iter().chain(self.shader.functions().map(|(id, _)| id));
        let mut order: Vec<FunctionId> = Vec::new();
        let mut printed = vec![false; self.shader.functions.len()];
        for root in roots {
            for id in self.shader.callees_first(root) {
                if let Some(done) = printed.get_mut(id.index()).filter(|done| !**done) {
                    *done = true;
                    order.push(id);
                }
            }
        }
        order
    }

    fn function(&mut self, id: FunctionId) {
        let shader = self.shader;
        let function = shader.function(id);
        self.function = Some(id);
        self.blank();
        let head = self.function_head(id, function);
        match &function.body {
            None => self.line(&format!("{head};")),
            Some(body) => {
                self.line(&format!("{head} {{"));
                self.body(body);
                self.line("}");
            }
        }
        self.function = None;
    }

    fn function_head(&self, id: FunctionId, function: &Function) -> String {
        use super::{LocalKind, ParamMode};
        let params: Vec<String> = function
            .params()
            .iter()
            .enumerate()
            .map(|(index, param)| {
                let mode = match param.kind {
                    LocalKind::Param(ParamMode::Out) => "out ",
                    LocalKind::Param(ParamMode::Inout) => "inout ",
                    LocalKind::Param(ParamMode::ConstIn) => "const ",
                    LocalKind::Param(ParamMode::In) | LocalKind::Variable | LocalKind::Const => "",
                };
                let name = self.names.local(id, super::LocalId::new(index));
                format!("{mode}{} {name}", self.type_name(param.ty)).trim_end().to_owned()
            })
            .collect();
        let name = self.names.function(id);
        format!("{} {name}({})", self.type_name(function.ret), params.join(", "))
    }
}
