//! Loads `[draw.uniforms]` and `[draw.matrices]` as the flat values of each root.
//!
//! *Holds:* a uniform that is not listed keeps its initializer, or is 0 (GLSL 1.50 §4.3.5).

use super::depths::DepthMap;
use super::harmonics::{HARMONICS, Harmonics};
use super::lights::{LightSpace, Lighting, Member};
use super::material::Material;
use super::matrices::{ROLES, View};
use super::paste::{self, Lines, key, names as names_of};
use crate::fixed::{FixedFunction, SetError, is_fixed_uniform};
use crate::reads::is_leaf_read;
use crate::roles::{MatrixRole, is_plain_transform, matrix_role};
use crate::tables::{Node, Number, NumberValue, Reader, report_unknown_name};
use crate::values::{Fill, UniformValues, bits, value_text};
use glam::DVec3;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{
    SCENE_UNSET_UNIFORM, SCENE_WRONG_KIND, SCENE_WRONG_SIZE, SCENE_WRONG_VALUE,
};
use glisten_front::hir::{Scalar, ScalarValue, Type, Types};
use glisten_front::link::{Program, UniformLeaf};
use glisten_front::source::Span;
use toml::de::DeTable;

/// The largest number of lines to paste that a help text gives, and of numbers in one of them.
const MAX_LINES: usize = 64;
const MAX_NEUTRAL: usize = 256;
/// The help text for a program of the library without a material.
const MATERIAL: &str = "add `material = { diffuse = [0.8, 0.8, 0.8] }` to the draw";
/// The largest number of declarations that a diagnostic shows.
const MAX_LABELS: usize = 6;

/// The values of all roots, while they are being set.
struct Values<'p> {
    program: &'p Program,
    given: UniformValues,
    set: Vec<Vec<bool>>,
}

/// The sources of a draw's uniform values besides its own table.
pub(super) struct Context<'a> {
    pub(super) program: &'a Program,
    pub(super) view: &'a View,
    pub(super) lighting: &'a Lighting,
    /// The coefficients of the light from all around.
    pub(super) harmonics: Option<&'a Harmonics>,
    pub(super) space: LightSpace,
    /// Whether matrices go to uniforms named after their roles, by the convention of the library's programs.
    pub(super) conventional: bool,
    /// Whether there is a camera or a mesh, so that matrices follow from something.
    pub(super) is_seen: bool,
    /// The maps of depths among its textures.
    pub(super) maps: &'a [DepthMap],
}

/// The value of each root of the program, in order, flat. The draw's own tables take precedence over the scene's
/// lights, the material and the library's conventions.
pub(super) fn load_uniforms(
    reader: &mut Reader,
    draw: &DeTable<'_>,
    context: &Context<'_>,
    material: Option<&(Material, &Node<'_>)>,
    fixed: Option<&mut FixedFunction>,
    place: Span,
) -> Vec<Vec<ScalarValue>> {
    let Context { program, view, .. } = *context;
    let mut values = Values::initial(program);
    let mut own = Own { state: fixed, values: Vec::new() };
    if context.conventional {
        values.fill_roles(view);
    }
    values.fill_lights(reader, context, place);
    values.fill_harmonics(reader, context.harmonics);
    if let Some((material, node)) = material {
        let span = reader.span_of(node);
        for (name, value) in material {
            values.offer(reader, name, *value, span);
        }
    }
    load_matrices(reader, draw, view, (&mut values, &mut own));
    load_maps(reader, context.maps, &mut values);
    load_named(reader, draw, (&mut values, &mut own));
    own.derive(&mut values);
    let asks_for_material = context.conventional && material.is_none();
    values.warn_unset(reader, draw, (context.is_seen, asks_for_material, place));
    values.given.roots
}

/// `[draw.matrices]`: the matrices of roles.
fn load_matrices<'p>(
    reader: &mut Reader,
    draw: &DeTable<'_>,
    view: &View,
    (values, own): (&mut Values<'p>, &mut Own<'p, '_>),
) {
    let Some(table) = reader.table_at(draw, "matrices") else { return };
    for (name, node) in table {
        let span = reader.span_of(name);
        let role = reader.choice(node, name.get_ref(), ROLES);
        if let Some(role) = role {
            let numbers = [Type::Matrix(4, 4), Type::Matrix(3, 3), Type::Vector(Scalar::Float, 3)]
                .into_iter()
                .find_map(|ty| view.matrix(role, ty));
            own.set(name.get_ref(), &numbers.unwrap_or_default());
        }
        if own.is_only_state(values.program, name.get_ref()) {
            continue;
        }
        let Some(target) = values.find(reader, name.get_ref(), span) else { continue };
        let Some(role) = role else {
            values.mark(&target);
            continue;
        };
        let numbers = view.matrix(role, values.program.types.get(target.leaf.ty));
        let whole_array = target.element.is_none() && target.leaf.array_size.is_some();
        let Some(numbers) = numbers.filter(|_| !whole_array) else {
            let declared = values.program.types.name(target.leaf.ty);
            let message = format!("`{}` is declared {declared}, which this role does not fit", target.leaf.name);
            let span = reader.span_of(node);
            reader.error(&SCENE_WRONG_KIND, span, message, "this role has another type");
            values.mark(&target);
            continue;
        };
        let scalars: Vec<ScalarValue> = numbers.into_iter().map(ScalarValue::Float).collect();
        values.store(&target, &scalars);
        own.keep(target, scalars);
    }
}

/// The matrices of maps of depths.
fn load_maps(reader: &mut Reader, maps: &[DepthMap], values: &mut Values<'_>) {
    for map in maps {
        let Some((name, span)) = &map.matrix else { continue };
        let Some(target) = values.find(reader, name, *span) else { continue };
        if values.program.types.get(target.leaf.ty) == Type::Matrix(4, 4) && target.leaf.array_size.is_none() {
            let scalars: Vec<ScalarValue> = map.to_map().into_iter().map(ScalarValue::Float).collect();
            values.store(&target, &scalars);
        } else {
            let message = format!("`{name}` is not a mat4, and a matrix leads from world space to a map");
            reader.error(&SCENE_WRONG_KIND, *span, message, "not for this uniform");
            values.mark(&target);
        }
    }
}

/// `[draw.uniforms]`: values by name.
fn load_named<'p>(reader: &mut Reader, draw: &DeTable<'_>, (values, own): (&mut Values<'p>, &mut Own<'p, '_>)) {
    let Some(table) = reader.table_at(draw, "uniforms") else { return };
    for (name, node) in table {
        let span = reader.span_of(name);
        if own.is_only_state(values.program, name.get_ref()) {
            own.load(reader, name.get_ref(), node);
            continue;
        }
        let Some(target) = values.find(reader, name.get_ref(), span) else { continue };
        let numbers = reader.numbers(node, name.get_ref());
        let span = reader.span(node.span());
        match numbers.and_then(|numbers| convert(reader, &values.program.types, &target, &numbers, span)) {
            Some(scalars) => {
                values.store(&target, &scalars);
                own.set(name.get_ref(), &floats(&scalars));
                own.keep(target, scalars);
            }
            // Of an array with a wrong element no other one is missed.
            None => values.mark(&Target { element: None, ..target }),
        }
    }
}

/// The draw's own values for state of the fixed-function pipeline, from which the rest is derived.
struct Own<'p, 's> {
    state: Option<&'s mut FixedFunction>,
    values: Vec<(Target<'p>, Vec<ScalarValue>)>,
}

impl<'p> Own<'p, '_> {
    /// Whether a name is state that the program itself does not read. It may read what follows from it.
    fn is_only_state(&self, program: &Program, name: &str) -> bool {
        let root = name.split(['.', '[']).next().unwrap_or(name);
        let reads = |root: &str| program.interface.roots.iter().any(|known| known.name == root);
        self.state.is_some() && is_fixed_uniform(root) && !reads(root)
    }

    /// Sets state. Derived values and other names are no state.
    fn set(&mut self, name: &str, numbers: &[f32]) {
        if let Some(state) = &mut self.state {
            let numbers: Vec<f64> = numbers.iter().map(|&number| f64::from(number)).collect();
            let _ = state.set(name, &numbers);
        }
    }

    /// Sets state that the program does not read.
    fn load(&mut self, reader: &mut Reader, name: &str, node: &Node<'_>) {
        let Some(numbers) = reader.numbers(node, name) else { return };
        let number = |number: &Number| match number.value {
            NumberValue::Float(value) | NumberValue::Int(_, value) => f64::from(value),
            NumberValue::Bool(value) => f64::from(u8::from(value)),
        };
        let numbers: Vec<f64> = numbers.iter().map(number).collect();
        let Some(state) = &mut self.state else { return };
        let span = reader.span_of(node);
        match state.set(name, &numbers) {
            Ok(()) => {}
            // A derived value that nothing reads.
            Err(SetError::Unknown) if !name.contains(['.', '[']) => {}
            Err(SetError::Unknown) => {
                let message = format!("the fixed-function pipeline has no state `{name}`");
                reader.error(&SCENE_WRONG_VALUE, span, message, "no such state");
            }
            Err(SetError::Count { wanted }) => {
                let message = format!("`{name}` takes {wanted} number{}, not {}", plural(wanted), numbers.len());
                reader.error(&SCENE_WRONG_SIZE, span, message, &format!("expected {wanted} number{}", plural(wanted)));
            }
        }
    }

    fn keep(&mut self, target: Target<'p>, scalars: Vec<ScalarValue>) {
        if self.state.is_some() && target.leaf.name.starts_with("gl_") {
            self.values.push((target, scalars));
        }
    }

    /// Gives all state its value, derived from the draw's own where that gives none.
    fn derive(self, values: &mut Values<'p>) {
        let Some(state) = self.state else { return };
        for (root, into) in values.program.interface.roots.iter().zip(&mut values.given.roots) {
            if let Some(derived) = state.root_values(root).filter(|derived| derived.len() == into.len()) {
                *into = derived;
            }
        }
        for (target, scalars) in &self.values {
            values.store(target, scalars);
        }
    }
}

fn floats(scalars: &[ScalarValue]) -> Vec<f32> {
    scalars.iter().map(|&value| f32::from_bits(bits(value))).collect()
}

/// A leaf, or one element of a leaf.
struct Target<'p> {
    leaf: &'p UniformLeaf,
    element: Option<u32>,
}

impl<'p> Values<'p> {
    fn initial(program: &'p Program) -> Self {
        let given = UniformValues::initial(program);
        let roots = program.interface.roots.iter().zip(&given.roots);
        let set = roots.map(|(root, values)| vec![root.default.is_some(); values.len()]).collect();
        Self { program, given, set }
    }

    /// The uniform that a name in the scene refers to. The one that a misspelled name is most similar to counts as set.
    fn find(&mut self, reader: &mut Reader, name: &str, span: Span) -> Option<Target<'p>> {
        let leaves = &self.program.interface.uniforms;
        if let Some((leaf, element)) = UniformValues::find(self.program, name) {
            let size = leaf.array_size.unwrap_or(1);
            if element.is_none_or(|element| element < size) {
                return Some(Target { leaf, element });
            }
            let message = format!("`{}` has {size} elements, so there is no `{name}`", leaf.name);
            reader.error(&SCENE_WRONG_SIZE, span, message, "past the last element");
            self.mark(&Target { leaf, element: None });
            return None;
        }
        let interface = &self.program.interface;
        if interface.samplers.iter().any(|sampler| sampler.name == name) {
            let message = format!("`{name}` is a sampler");
            let diagnostic =
                Diagnostic::new(&SCENE_WRONG_KIND, span, message).here("no number can be given to it").help(format!(
                    "give it a texture: `{name} = {{ width = .., height = .., values = [..] }}` under [draw.textures]"
                ));
            reader.report(diagnostic);
            return None;
        }
        if interface.attributes.iter().any(|attribute| attribute.name == name) {
            let diagnostic =
                Diagnostic::new(&SCENE_WRONG_KIND, span, format!("`{name}` is an attribute, not a uniform"))
                    .help("put it under [draw.attributes]");
            reader.report(diagnostic);
            return None;
        }
        let candidates: Vec<&str> = leaves.iter().map(|leaf| leaf.name.as_str()).collect();
        let near = report_unknown_name(reader, span, "uniform", name, &candidates);
        if let Some((leaf, element)) = near.and_then(|near| UniformValues::find(self.program, near)) {
            self.mark(&Target { leaf, element });
        }
        None
    }

    /// Notes that the scene gives the target a value, though it may be a wrong one.
    fn mark(&mut self, target: &Target<'_>) {
        let each = self.program.types.flat_len(target.leaf.ty);
        let (first, len) = match (target.element, target.leaf.array_size) {
            (Some(0) | None, size) => (0, each * size.unwrap_or(1)),
            (Some(element), _) => (each * element, each),
        };
        let start = (target.leaf.flat_offset + first) as usize;
        let set = self.set.get_mut(target.leaf.root.0 as usize);
        if let Some(set) = set.and_then(|set| set.get_mut(start..start + len as usize)) {
            set.fill(true);
        }
    }

    /// Sets the uniforms with the names and types of roles to their matrices.
    fn fill_roles(&mut self, view: &View) {
        for (name, role) in ROLES {
            let leaf = self.program.interface.uniforms.iter().find(|leaf| leaf.name == *name);
            let leaf = leaf.filter(|leaf| leaf.array_size.is_none());
            if let Some((leaf, numbers)) =
                leaf.and_then(|leaf| Some((leaf, view.matrix(*role, self.program.types.get(leaf.ty))?)))
            {
                let scalars: Vec<ScalarValue> = numbers.into_iter().map(ScalarValue::Float).collect();
                self.store(&Target { leaf, element: None }, &scalars);
            }
        }
    }

    /// Sets the uniforms `light`, `lights` and `global_ambient` to the scene's lights, as far as the program declares
    /// them.
    fn fill_lights(&mut self, reader: &mut Reader, context: &Context<'_>, place: Span) {
        let Lighting { lights, global_ambient, .. } = context.lighting;
        let program = self.program;
        if lights.is_empty() && !context.conventional {
            return;
        }
        let Some(root) = program.interface.roots.iter().position(|root| root.name == "light") else { return };
        let room = match program.interface.roots.get(root).map(|root| program.types.get(root.ty)) {
            Some(Type::Array(_, glisten_front::hir::ArraySize::Sized(size))) => size as usize,
            _ => {
                let message = "a scene's lights go to a uniform array `light`, and here `light` is none".to_owned();
                reader.error(&SCENE_WRONG_KIND, place, message, "in this draw");
                return;
            }
        };
        if let Some(light) = lights.get(room) {
            let message = format!("the scene has {} lights, and the program takes {room}", lights.len());
            let help = format!("add `defines = {{ GLISTEN_LIGHTS = {} }}` to the draw", lights.len());
            reader.report(Diagnostic::new(&SCENE_WRONG_SIZE, light.span, message).here("one too many").help(help));
            for (root, set) in program.interface.roots.iter().zip(&mut self.set) {
                if ["light", "lights", "global_ambient"].contains(&root.name.as_str()) {
                    set.fill(true);
                }
            }
            return;
        }
        // Lights beyond those of the scene are zero, which needs no warning.
        if let Some(set) = self.set.get_mut(root) {
            set.fill(true);
        }
        for (index, light) in lights.iter().enumerate() {
            for (member, value) in light.members(context.space, context.view.view_matrix()) {
                self.offer(reader, &format!("light[{index}].{member}"), value, light.span);
            }
        }
        self.offer(reader, "lights", Member::Int(lights.len() as i32), place);
        self.offer(reader, "global_ambient", Member::Vector(*global_ambient), place);
    }

    /// Sets the uniform `harmonics` to the coefficients of the environment, if the program declares it.
    fn fill_harmonics(&mut self, reader: &mut Reader, harmonics: Option<&Harmonics>) {
        let Some(harmonics) = harmonics else { return };
        let Some(leaf) = self.program.interface.uniforms.iter().find(|leaf| leaf.name == HARMONICS) else { return };
        if self.program.types.get(leaf.ty) == Type::Vector(Scalar::Float, 3) && leaf.array_size == Some(9) {
            let numbers = harmonics.coefficients.iter().flat_map(DVec3::to_array);
            let scalars: Vec<ScalarValue> = numbers.map(|number| ScalarValue::Float(number as f32)).collect();
            self.store(&Target { leaf, element: None }, &scalars);
        } else {
            let message = format!("the light from all around goes to a uniform `vec3 {HARMONICS}[9]`");
            reader.error(&SCENE_WRONG_KIND, harmonics.span, message, "here it has another type");
        }
    }

    /// Sets a leaf to a value, if there is one with this name.
    fn offer(&mut self, reader: &mut Reader, name: &str, value: Member, span: Span) {
        let Some(leaf) = self.program.interface.uniforms.iter().find(|leaf| leaf.name == name) else { return };
        let (shape, scalars) = match value {
            Member::Int(value) => (Type::Scalar(Scalar::Int), vec![ScalarValue::Int(value)]),
            Member::Float(value) => (Type::Scalar(Scalar::Float), vec![ScalarValue::Float(value as f32)]),
            Member::Pair(value) => {
                (Type::Vector(Scalar::Float, 2), value.map(|value| ScalarValue::Float(value as f32)).to_vec())
            }
            Member::Vector(value) => {
                (Type::Vector(Scalar::Float, 3), value.map(|value| ScalarValue::Float(value as f32)).to_vec())
            }
        };
        if self.program.types.get(leaf.ty) == shape && leaf.array_size.is_none() {
            self.store(&Target { leaf, element: None }, &scalars);
            return;
        }
        let message = format!("`{name}` is declared {}", self.program.types.name(leaf.ty));
        let wanted = match value {
            Member::Int(_) => "an int",
            Member::Float(_) => "a float",
            Member::Pair(_) => "a vec2",
            Member::Vector(_) => "a vec3",
        };
        let help = "<glisten/scene.glsl> declares what scenes fill";
        let here = format!("this gives it {wanted}");
        reader.report(Diagnostic::new(&SCENE_WRONG_KIND, span, message).here(here).help(help));
    }

    /// Sets the values of a uniform, and of all others with its name: blocks without an instance name, one for each stage, may
    /// have members of the same name (GLSL 4.50 §4.3.9).
    fn store(&mut self, target: &Target<'_>, scalars: &[ScalarValue]) {
        let wanted = target.leaf;
        let is_same = |leaf: &&UniformLeaf| {
            leaf.name == wanted.name && leaf.ty == wanted.ty && leaf.array_size == wanted.array_size
        };
        for leaf in self.program.interface.uniforms.iter().filter(is_same) {
            let first = (self.program.types.flat_len(leaf.ty) * target.element.unwrap_or(0)) as usize;
            let start = leaf.flat_offset as usize + first;
            if self.given.set(leaf, first, scalars)
                && let Some(set) = self.set.get_mut(leaf.root.0 as usize)
                && let Some(set) = set.get_mut(start..start + scalars.len())
            {
                set.fill(true);
            }
        }
    }

    /// Warns about leaves that have no value, once for the draw.
    fn warn_unset(
        &self,
        reader: &mut Reader,
        draw: &DeTable<'_>,
        (is_seen, asks_for_material, place): (bool, bool, Span),
    ) {
        let interface = &self.program.interface;
        let is_open = |leaf: &&UniformLeaf| {
            let root = interface.roots.get(leaf.root.0 as usize);
            root.is_some_and(|root| root.active && root.default.is_none()) && !self.is_set(leaf)
        };
        let unset: Vec<&UniformLeaf> = interface.uniforms.iter().filter(is_open).collect();
        let names: Vec<String> = unset.iter().flat_map(|leaf| self.names_without_value(leaf)).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let message = match names.len() {
            0 => return,
            1 => format!("uniform {} gets no value and is 0", names_of(&names)),
            _ => format!("uniforms {} get no value and are 0", names_of(&names)),
        };
        let mut diagnostic = Diagnostic::new(&SCENE_UNSET_UNIFORM, place, message);
        let mut roots: Vec<u32> = unset.iter().map(|leaf| leaf.root.0).collect();
        roots.dedup();
        for root in roots.into_iter().filter_map(|root| interface.roots.get(root as usize)).take(MAX_LABELS) {
            let declared = root.globals.first().and_then(|&(stage, global)| {
                self.program.stage(stage).and_then(|shader| shader.globals.get(global.index()))
            });
            if let Some(global) = declared {
                diagnostic = diagnostic.label(global.span, "declared here");
            }
        }
        let of_material = |leaf: &&UniformLeaf| {
            asks_for_material && (leaf.name.starts_with("material.") || leaf.name.starts_with("finish."))
        };
        let (material, others): (Vec<&UniformLeaf>, Vec<&UniformLeaf>) = unset.into_iter().partition(of_material);
        let lines = self.lines_to_add(reader, draw, &others, is_seen);
        let material = (!material.is_empty()).then(|| MATERIAL.to_owned());
        let help = match (material, lines) {
            (Some(material), Some(lines)) => Some(format!("{material}\nand {lines}")),
            (material, lines) => material.or(lines),
        };
        reader.report_missing(diagnostic.maybe_help(help));
    }

    /// The help text for uniforms without a value: the lines to paste.
    fn lines_to_add(
        &self,
        reader: &Reader,
        draw: &DeTable<'_>,
        unset: &[&UniformLeaf],
        is_seen: bool,
    ) -> Option<String> {
        let mut matrices = Lines::new("matrices", Vec::new());
        let mut values = Lines::new("uniforms", Vec::new());
        for leaf in unset {
            let role = self.role(leaf, unset).filter(|_| is_seen);
            let (lines, value) = match role {
                Some(role) => (&mut matrices, format!("\"{}\"", role.name())),
                None => (&mut values, value_text(&self.program.types, leaf, Fill::Zero, MAX_NEUTRAL)),
            };
            if lines.lines.len() < MAX_LINES {
                lines.lines.push(format!("{} = {value}", key(&leaf.name)));
            } else {
                lines.n_more += 1;
            }
        }
        paste::help(reader, draw, &[matrices, values])
    }

    /// The role that the name of a uniform says.
    fn role(&self, leaf: &UniformLeaf, others: &[&UniformLeaf]) -> Option<MatrixRole> {
        let of = |leaf: &UniformLeaf| {
            let member = leaf.name.rsplit('.').next().unwrap_or(&leaf.name);
            (member.to_owned(), self.program.types.get(leaf.ty))
        };
        let (name, ty) = of(leaf);
        if leaf.array_size.is_some() {
            return None;
        }
        let is_alone = || {
            let has_role = |other: &&&UniformLeaf| {
                let (name, ty) = of(other);
                ty == Type::Matrix(4, 4) && matrix_role(&name, ty).is_some()
            };
            !others.iter().any(|other| has_role(&other))
        };
        let plain = || {
            let role = if is_alone() { MatrixRole::ModelViewProjection } else { MatrixRole::Model };
            (is_plain_transform(&name) && role.fits(ty)).then_some(role)
        };
        matrix_role(&name, ty).or_else(plain)
    }

    /// The name of a leaf that lacks a value, or those of its elements that do, if others have one.
    fn names_without_value(&self, leaf: &UniformLeaf) -> Vec<String> {
        let each = self.program.types.flat_len(leaf.ty).max(1) as usize;
        let start = leaf.flat_offset as usize;
        let set = self.set.get(leaf.root.0 as usize).and_then(|set| set.get(start..)).unwrap_or_default();
        let elements = set.chunks(each).take(leaf.array_size.unwrap_or(1) as usize).enumerate();
        let is_open = |(_, set): &(usize, &[bool])| !set.iter().all(|&set| set);
        let open: Vec<usize> = elements.filter(is_open).map(|(element, _)| element).collect();
        match leaf.array_size {
            Some(size) if open.len() < size as usize => {
                open.into_iter().map(|element| format!("{}[{element}]", leaf.name)).collect()
            }
            _ => vec![leaf.name.clone()],
        }
    }

    fn is_set(&self, leaf: &UniformLeaf) -> bool {
        let len = self.program.types.flat_len(leaf.ty) * leaf.array_size.unwrap_or(1);
        let start = leaf.flat_offset as usize;
        self.set
            .get(leaf.root.0 as usize)
            .and_then(|set| set.get(start..start + len as usize))
            .is_none_or(|set| set.iter().all(|&set| set))
            // Nobody misses what nothing reads.
            || !is_leaf_read(self.program, leaf)
    }
}

fn convert(
    reader: &mut Reader,
    types: &Types,
    target: &Target<'_>,
    numbers: &[Number],
    span: Span,
) -> Option<Vec<ScalarValue>> {
    let leaf = target.leaf;
    let each = types.flat_len(leaf.ty) as usize;
    let whole = each * leaf.array_size.unwrap_or(1) as usize;
    let fits = match (leaf.array_size, target.element) {
        (None, _) | (Some(_), None) => numbers.len() == whole,
        (Some(_), Some(0)) => numbers.len() == each || numbers.len() == whole,
        (Some(_), Some(_)) => numbers.len() == each,
    };
    if !fits {
        let declared = types.name(leaf.ty);
        let message = match leaf.array_size {
            None => {
                let declared = with_article(&declared);
                format!("`{}`, {declared}, takes {whole} number{}, not {}", leaf.name, plural(whole), numbers.len())
            }
            Some(size) => format!(
                "`{}`, {size} elements of {declared}, takes {whole} numbers (one element {each}), not {}",
                leaf.name,
                numbers.len()
            ),
        };
        reader.error(&SCENE_WRONG_SIZE, span, message, &format!("expected {whole} numbers"));
        return None;
    }
    let scalar = types.scalar_of(leaf.ty).unwrap_or(Scalar::Float);
    let mut scalars = Vec::with_capacity(numbers.len());
    for number in numbers {
        let Some(value) = scalar_value(scalar, number.value) else {
            let wanted = match scalar {
                Scalar::Float => "numbers",
                Scalar::Bool => "`true` and `false`",
                Scalar::Int => "integers of 32 bits",
                Scalar::Uint => "unsigned integers of 32 bits",
            };
            let message = format!("`{}`, {}, takes {wanted}", leaf.name, with_article(&types.name(leaf.ty)));
            reader.error(&SCENE_WRONG_KIND, number.span, message, "expected another kind of number");
            return None;
        };
        scalars.push(value);
    }
    Some(scalars)
}

/// The name of a type as of one thing: `an ivec3`, `a uint`.
fn with_article(name: &str) -> String {
    let article = if name.starts_with('i') { "an" } else { "a" };
    format!("{article} {name}")
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

fn scalar_value(scalar: Scalar, number: NumberValue) -> Option<ScalarValue> {
    match (scalar, number) {
        (Scalar::Float, NumberValue::Float(value) | NumberValue::Int(_, value)) => Some(ScalarValue::Float(value)),
        (Scalar::Int, NumberValue::Int(value, _)) => i32::try_from(value).ok().map(ScalarValue::Int),
        (Scalar::Uint, NumberValue::Int(value, _)) => u32::try_from(value).ok().map(ScalarValue::Uint),
        (Scalar::Bool, NumberValue::Bool(value)) => Some(ScalarValue::Bool(value)),
        (Scalar::Bool, NumberValue::Int(value, _)) => Some(ScalarValue::Bool(value != 0)),
        (Scalar::Bool, NumberValue::Float(value)) => Some(ScalarValue::Bool(value != 0.0)),
        (Scalar::Float | Scalar::Int | Scalar::Uint, NumberValue::Bool(_))
        | (Scalar::Int | Scalar::Uint, NumberValue::Float(_)) => None,
    }
}
