//! Prints the typed program as readable GLSL 1.50.
//!
//! *In:* a [`Shader`] without errors, and its [`Types`]. *Out:* one text with the same meaning. It writes out every
//! implicit conversion, gives every array its size, and uses every name for one thing within a function. Structs come
//! first, then globals in their order, then functions, callees before callers, so that prototypes are not needed.
//!
//! *Holds:* parsing the text and printing it again gives the same text.

mod declarations;
mod expressions;
mod names;
mod scoped;
mod statements;

use super::{Function, FunctionId, Global, GlobalId, Shader, Type, TypeId, Types};
use crate::builtin::BuiltinVariable;
use crate::source::Span;
use crate::source::comments::AroundBody;
use names::{NameTable, ScopedNames};

/// Comments for what is printed, by its span, and what is left out.
pub trait Notes {
    /// Whether a global is printed.
    fn keeps_global(&self, _global: &Global) -> bool {
        true
    }
    /// Whether a function is printed.
    fn keeps_function(&self, _function: &Function) -> bool {
        true
    }
    /// More words of the layout of a global: `set = 1`.
    fn layout(&self, _global: GlobalId) -> Vec<String> {
        Vec::new()
    }
    /// The name of a built-in variable.
    fn builtin_name(&self, builtin: BuiltinVariable) -> &'static str {
        builtin.name()
    }
    /// The lines of comment above it, as they are written.
    fn above(&self, span: Span) -> Vec<String>;
    /// The comment behind it on its last line.
    fn behind(&self, span: Span) -> Option<String>;
    /// The comments around the body of the function of this name.
    fn around_body(&self, _name: Span) -> Option<AroundBody> {
        None
    }
}

/// Prints a shader.
pub fn print(types: &Types, shader: &Shader) -> String {
    print_with(types, shader, None)
}

/// Prints a shader with comments, and with names that are given again in scopes apart, as people do.
pub fn print_with(types: &Types, shader: &Shader, notes: Option<&dyn Notes>) -> String {
    shader.on_stack(|| {
        let scoped: ScopedNames<'_> = &|table, function| scoped::local_names(table, types, shader, function);
        let builtin_name = |builtin: BuiltinVariable| notes.map_or(builtin.name(), |notes| notes.builtin_name(builtin));
        let names = NameTable::new(types, shader, &builtin_name, notes.is_some().then_some(scoped));
        let mut printer = Printer { types, shader, names, notes, function: None, text: String::new(), indent: 0 };
        printer.shader();
        printer.text
    })
}

/// The state of the printer.
struct Printer<'a> {
    types: &'a Types,
    shader: &'a Shader,
    names: NameTable,
    notes: Option<&'a dyn Notes>,
    /// The current function.
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

    /// Prints the comment above something.
    fn above(&mut self, span: Span) {
        for line in self.notes.map_or_else(Vec::new, |notes| notes.above(span)) {
            self.line(&line);
        }
    }

    /// Prints the comment behind something on its line, which was just printed.
    fn behind(&mut self, span: Span) {
        if let Some(comment) = self.notes.and_then(|notes| notes.behind(span))
            && self.text.ends_with('\n')
        {
            self.text.pop();
            self.text.push_str("  ");
            self.text.push_str(&comment);
            self.text.push('\n');
        }
    }

    /// The words that the caller adds to the layout of a global.
    fn layout_words(&self, id: GlobalId) -> Vec<String> {
        self.notes.map_or_else(Vec::new, |notes| notes.layout(id))
    }

    fn blank(&mut self) {
        if !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    /// The type as written before a name: `float[3]`.
    fn type_name(&self, ty: TypeId) -> String {
        match self.types.get(ty) {
            Type::Struct(id) => match self.names.structure(id) {
                // The language declares it.
                "" => self.types.structure(id).name.clone(),
                name => name.to_owned(),
            },
            Type::Array(..) => {
                // The outermost size comes first.
                let (mut base, mut dims) = (ty, String::new());
                while let Type::Array(element, size) = self.types.get(base) {
                    dims.push_str(&match size {
                        super::ArraySize::Sized(size) => format!("[{size}]"),
                        super::ArraySize::Unsized => "[]".into(),
                    });
                    base = element;
                }
                self.type_name(base) + &dims
            }
            _ => self.types.name(ty),
        }
    }

    /// The functions in print order, callees before callers: first those that `main` needs, then the others.
    fn function_order(&self) -> Vec<FunctionId> {
        let roots = self.shader.main.into_iter().chain(self.shader.functions().map(|(id, _)| id));
        self.shader.callees_first_of(roots)
    }

    fn function(&mut self, id: FunctionId) {
        let shader = self.shader;
        let function = shader.function(id);
        if !self.notes.is_none_or(|notes| notes.keeps_function(function)) {
            return;
        }
        self.function = Some(id);
        self.blank();
        self.above(function.span);
        let head = self.function_head(id, function);
        match &function.body {
            None => self.line(&format!("{head};")),
            Some(body) => {
                let around = self.notes.and_then(|notes| notes.around_body(function.span)).unwrap_or_default();
                self.line(format!("{head} {{  {}", around.head).trim_end());
                self.body(body);
                around.last.iter().for_each(|line| self.line(&format!("    {line}")));
                self.line(format!("}}  {}", around.behind).trim_end());
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
                format!("{}{mode}{} {name}", self.precise(param.span), self.type_name(param.ty)).trim_end().to_owned()
            })
            .collect();
        let name = self.names.function(id);
        let precise = self.precise(function.span);
        format!("{precise}{} {name}({})", self.type_name(function.ret), params.join(", "))
    }
}
