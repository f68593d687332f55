//! Writes a module: its structs, constants, variables and functions.

use super::declarations::{declare, return_at_once};
use super::expressions::{Try, number};
use super::function::{Builder, Built, Context};
use super::inverse::Inverses;
use super::names::{Names, short_type};
use super::notes::Notes;
use super::print::Marks;
use super::tree::Expr;
use super::{Style, effects, print, scopes};
use crate::emit::emitted::Origin;
use glisten_front::source::Span;
use naga::common::wgsl::{ToWgsl, TryToWgsl, address_space_str};
use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    Arena, Binding, BuiltIn, Expression, Function, Handle, Interpolation, Module, Sampling, ShaderStage, TypeInner,
};

/// Writes a module, with the comments of the source. Returns which lines come from where, too.
pub(super) fn write(module: &Module, info: &ModuleInfo, style: Style, notes: &Notes<'_>) -> Try<(String, Vec<Origin>)> {
    let inverses = Inverses::of(module, info);
    let names = Names::of(module, inverses.names());
    let effects = effects::of_functions(module);
    let context = Context { module, names: &names, effects: &effects, style };
    let mut writer = Writer { context, inverses: &inverses, notes, text: String::new(), marks: Marks::new() };
    writer.enables();
    writer.structs()?;
    writer.variables()?;
    for (handle, function) in module.functions.iter() {
        let span = module.functions.get_span(handle);
        writer.function(names.function(handle), None, function, &info[handle], span)?;
    }
    for (index, entry) in module.entry_points.iter().enumerate() {
        let span = notes.main(entry.stage);
        writer.function(names.entry(index), Some(entry.stage), &entry.function, info.get_entry_point(index), span)?;
    }
    writer.text.truncate(writer.text.trim_end().len());
    writer.text.push('\n');
    let inverses = inverses.text();
    writer.text.push_str(&inverses);
    let origins = origins(&writer.text, &writer.marks);
    Ok((writer.text, origins))
}

/// The lines of the places of a text.
fn origins(text: &str, marks: &Marks) -> Vec<Origin> {
    let (mut line, mut last) = (1, 0);
    let lines = marks.iter().filter_map(|&(at, span)| {
        line += text.get(last..at)?.matches('\n').count() as u32;
        last = at;
        let range = span.to_range()?;
        Some(Origin { line, span: Span::new(range.start as u32, range.end as u32) })
    });
    lines.collect()
}

struct Writer<'m, 'n> {
    context: Context<'m>,
    inverses: &'m Inverses,
    notes: &'n Notes<'n>,
    text: String,
    marks: Marks,
}

impl<'m> Writer<'m, '_> {
    /// The extensions of the language that the module needs.
    fn enables(&mut self) {
        let module = self.context.module;
        let (mut half, mut blend, mut clip, mut primitive) = (false, false, false, false);
        let mut binding = |binding: Option<&Binding>| match binding {
            Some(Binding::Location { blend_src: Some(_), .. }) => blend = true,
            Some(Binding::BuiltIn(BuiltIn::ClipDistances)) => clip = true,
            Some(Binding::BuiltIn(BuiltIn::PrimitiveIndex)) => primitive = true,
            _ => {}
        };
        for (_, ty) in module.types.iter() {
            match &ty.inner {
                TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => {
                    half |= *scalar == naga::Scalar::F16;
                }
                TypeInner::Struct { members, .. } => {
                    members.iter().for_each(|member| binding(member.binding.as_ref()));
                }
                _ => {}
            }
        }
        for entry in &module.entry_points {
            binding(entry.function.result.as_ref().and_then(|result| result.binding.as_ref()));
            entry.function.arguments.iter().for_each(|argument| binding(argument.binding.as_ref()));
        }
        let rows =
            [(half, "f16"), (blend, "dual_source_blending"), (clip, "clip_distances"), (primitive, "primitive_index")];
        for (_, name) in rows.iter().filter(|(needed, _)| *needed) {
            self.text.push_str(&format!("enable {name};\n"));
        }
        self.blank();
    }

    /// An empty line, unless there is one or nothing.
    fn blank(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    fn comments(&mut self, indent: &str, lines: &[String]) {
        for line in lines {
            self.text.push_str(indent);
            self.text.push_str(line);
            self.text.push('\n');
        }
    }

    fn end_line(&mut self, behind: Option<&String>) {
        if let Some(behind) = behind {
            self.text.push_str("  ");
            self.text.push_str(behind);
        }
        self.text.push('\n');
    }

    fn structs(&mut self) -> Try<()> {
        let Context { module, names, .. } = self.context;
        for (handle, ty) in module.types.iter() {
            let TypeInner::Struct { members, .. } = &ty.inner else { continue };
            let name = names.ty(module, handle);
            let source = ty.name.as_deref().unwrap_or(&name);
            self.comments("", self.notes.above_struct(source));
            self.text.push_str(&format!("struct {name} {{\n"));
            for (index, member) in members.iter().enumerate() {
                let own = self.notes.of_member(source, member.name.as_deref().unwrap_or(""));
                self.comments(print::INDENT, own.map_or(&[], |note| note.above.as_slice()));
                self.text.push_str(print::INDENT);
                if let Some(binding) = &member.binding {
                    attributes(binding, &mut self.text)?;
                }
                self.text.push_str(names.member_name(handle, index as u32));
                self.text.push_str(": ");
                self.text.push_str(&names.ty(module, member.ty));
                self.text.push(',');
                self.end_line(own.and_then(|note| note.behind.as_ref()));
            }
            self.text.push_str("}\n\n");
        }
        Ok(())
    }

    fn variables(&mut self) -> Try<()> {
        let Context { module, names, .. } = self.context;
        for (handle, constant) in module.constants.iter() {
            let Some(name) = names.constant_name(handle) else { continue };
            let note = self.notes.of_variable(constant.name.as_deref().unwrap_or(""));
            self.comments("", note.map_or(&[], |note| note.above.as_slice()));
            let head = format!("const {name}: {} = ", names.ty(module, constant.ty));
            let value = print::expression(&head, &self.constant(constant.init, &module.global_expressions)?);
            self.text.push_str(&format!("{value};"));
            self.end_line(note.and_then(|note| note.behind.as_ref()));
        }
        self.blank();
        for (handle, variable) in module.global_variables.iter() {
            let note = self.notes.of_variable(variable.name.as_deref().unwrap_or(""));
            self.comments("", note.map_or(&[], |note| note.above.as_slice()));
            if let Some(binding) = &variable.binding {
                self.text.push_str(&format!("@group({}) @binding({}) ", binding.group, binding.binding));
            }
            let space = address_space_str(variable.space).0.map_or(String::new(), |space| format!("<{space}>"));
            let head = format!("var{space} {}: {}", names.global_name(handle), names.ty(module, variable.ty));
            match variable.init {
                Some(init) => {
                    let value = self.constant(init, &module.global_expressions)?;
                    self.text.push_str(&print::expression(&format!("{head} = "), &value));
                }
                None => self.text.push_str(&head),
            }
            self.text.push(';');
            self.end_line(note.and_then(|note| note.behind.as_ref()));
        }
        self.blank();
        Ok(())
    }

    /// An expression of the module, whose type is declared.
    fn constant(&self, handle: Handle<Expression>, expressions: &'m Arena<Expression>) -> Try<Expr<'m>> {
        let Context { module, names, .. } = self.context;
        Ok(match &expressions[handle] {
            Expression::Literal(literal) => number(*literal),
            Expression::ZeroValue(ty) => Expr::Call(names.ty(module, *ty).into(), Vec::new()),
            Expression::Constant(constant) => match names.constant_name(*constant) {
                Some(name) => Expr::Constant(name.into()),
                None => self.constant(module.constants[*constant].init, expressions)?,
            },
            Expression::Compose { ty, components } => {
                let arguments: Try<Vec<_>> =
                    components.iter().map(|component| self.constant(*component, expressions)).collect();
                let inner = &module.types[*ty].inner;
                match inner {
                    // Booleans and numbers with suffixes have one type.
                    TypeInner::Vector { .. } => Expr::Call(short_type(inner).into(), arguments?),
                    _ => Expr::Call(names.ty(module, *ty).into(), arguments?),
                }
            }
            other => return Err(format!("no constant of WGSL for {other:?}")),
        })
    }

    fn function(
        &mut self,
        name: &str,
        stage: Option<ShaderStage>,
        function: &'m Function,
        info: &'m FunctionInfo,
        span: naga::Span,
    ) -> Try<()> {
        let Context { module, names, style, .. } = self.context;
        let Built { mut body, parameters, locals } = Builder::build(&self.context, self.inverses, function, info)?;
        declare(&mut body, locals, style == Style::Full);
        if style == Style::Full && stage.is_some() {
            return_at_once(&mut body);
        }
        self.notes.comment_body(&mut body, span);
        let types: Vec<String> = function.arguments.iter().map(|argument| names.ty(module, argument.ty)).collect();
        scopes::choose(&mut body, &parameters, &types);
        let mut heads = Vec::with_capacity(types.len());
        for ((argument, ty), id) in function.arguments.iter().zip(&types).zip(&parameters) {
            let mut head = String::new();
            if let Some(binding) = &argument.binding {
                attributes(binding, &mut head)?;
            }
            head.push_str(body.names.get(id.0).map_or("", String::as_str));
            head.push_str(": ");
            head.push_str(ty);
            heads.push(head);
        }
        let mut result = String::new();
        if let Some(own) = &function.result {
            result.push_str("-> ");
            if let Some(binding) = &own.binding {
                attributes(binding, &mut result)?;
            }
            result.push_str(&names.ty(module, own.ty));
            result.push(' ');
        }
        self.comments("", self.notes.above_function(stage.is_some() || function.name.is_some(), span));
        self.text.push_str(match stage {
            None => "",
            Some(ShaderStage::Vertex) => "@vertex\n",
            Some(_) => "@fragment\n",
        });
        if span.is_defined() {
            self.marks.push((self.text.len(), span));
        }
        self.head(name, stage, function, &heads, &result);
        let (text, marks) = print::body(&body);
        let start = self.text.len();
        self.marks.extend(marks.into_iter().map(|(at, span)| (start + at, span)));
        self.text.push_str(&text);
        self.text.push_str("}\n\n");
        Ok(())
    }

    /// The head of a function; if it is long, with a line for each parameter.
    fn head(
        &mut self,
        name: &str,
        stage: Option<ShaderStage>,
        function: &Function,
        parameters: &[String],
        result: &str,
    ) {
        let flat = format!("fn {name}({}) {result}{{", parameters.join(", "));
        if flat.len() <= print::WIDTH {
            self.text.push_str(&flat);
            self.text.push('\n');
            return;
        }
        self.text.push_str(&format!("fn {name}(\n"));
        for (parameter, argument) in parameters.iter().zip(&function.arguments) {
            let note = argument.name.as_deref().zip(stage).and_then(|(name, stage)| self.notes.of_input(stage, name));
            self.comments(print::INDENT, note.map_or(&[], |note| note.above.as_slice()));
            self.text.push_str(&format!("{}{parameter},", print::INDENT));
            self.end_line(note.and_then(|note| note.behind.as_ref()));
        }
        self.text.push_str(&format!(") {result}{{\n"));
    }
}

/// The attributes of a built-in value or a location.
fn attributes(binding: &Binding, text: &mut String) -> Try<()> {
    match *binding {
        Binding::BuiltIn(builtin) => {
            let name = builtin.try_to_wgsl().ok_or_else(|| format!("WGSL has no {builtin:?}"))?;
            text.push_str(&format!("@builtin({name}) "));
            if builtin == (BuiltIn::Position { invariant: true }) {
                text.push_str("@invariant ");
            }
        }
        Binding::Location { location, interpolation, sampling, blend_src, .. } => {
            text.push_str(&format!("@location({location}) "));
            if let Some(source) = blend_src {
                text.push_str(&format!("@blend_src({source}) "));
            }
            let interpolation = interpolation.unwrap_or(Interpolation::Perspective);
            match sampling {
                Some(sampling) if sampling != Sampling::Center => {
                    text.push_str(&format!("@interpolate({}, {}) ", interpolation.to_wgsl(), sampling.to_wgsl()));
                }
                _ if interpolation != Interpolation::Perspective => {
                    text.push_str(&format!("@interpolate({}) ", interpolation.to_wgsl()));
                }
                _ => {}
            }
        }
    }
    Ok(())
}
