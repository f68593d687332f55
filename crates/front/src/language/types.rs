//! [`Types`]: the types of §4.1, interned.
//!
//! *Holds:* equal handles mean equal types. The basic types have the same handles in every table, so constants such
//! as [`TypeId::VEC4`] need no table. Two declarations of a struct are two types.

use rustc_hash::FxHashMap;
use std::hash::{Hash, Hasher};

/// The handle of a type in [`Types`]; equal handles mean equal types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TypeId(u32);

/// The handle of a struct in [`Types`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StructId(u32);

/// The basic scalar types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Scalar {
    Bool,
    Int,
    Uint,
    Float,
}

impl Scalar {
    /// All four, in the order of [`TypeId::vector`].
    pub const ALL: [Self; 4] = [Self::Bool, Self::Int, Self::Uint, Self::Float];

    /// `bool`, `int`, `uint`, `float`
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Int => "int",
            Self::Uint => "uint",
            Self::Float => "float",
        }
    }

    /// Whether the type is `int` or `uint`.
    pub fn is_integer(self) -> bool {
        matches!(self, Self::Int | Self::Uint)
    }
}

/// The dimensionality of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum SamplerDim {
    D1,
    D2,
    D3,
    Cube,
    Rect,
    Buffer,
    Multisample,
}

/// A sampler type (§4.1.7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SamplerType {
    /// The type of a texel's components: `Float`, `Int` or `Uint`.
    pub texel: Scalar,
    /// The dimensionality.
    pub dim: SamplerDim,
    /// `...Array`
    pub arrayed: bool,
    /// `...Shadow`
    pub shadow: bool,
}

impl SamplerType {
    /// All sampler types of GLSL 4.00, in the order in which [`Types`] stores them.
    pub const ALL: [Self; 40] = Self::list();

    const fn list() -> [Self; 40] {
        const SHAPES: [(SamplerDim, bool); 11] = [
            (SamplerDim::D1, false),
            (SamplerDim::D2, false),
            (SamplerDim::D3, false),
            (SamplerDim::Cube, false),
            (SamplerDim::Rect, false),
            (SamplerDim::D1, true),
            (SamplerDim::D2, true),
            (SamplerDim::Buffer, false),
            (SamplerDim::Multisample, false),
            (SamplerDim::Multisample, true),
            (SamplerDim::Cube, true),
        ];
        const SHADOWS: [usize; 7] = [0, 1, 3, 4, 5, 6, 10];
        const TEXELS: [Scalar; 3] = [Scalar::Float, Scalar::Int, Scalar::Uint];
        let (dim, arrayed) = SHAPES[0];
        let mut list = [Self { texel: Scalar::Float, dim, arrayed, shadow: false }; 40];
        let mut index = 0;
        while index < 40 {
            let plain = index < 33;
            let (dim, arrayed) = SHAPES[if plain { index / 3 } else { SHADOWS[index - 33] }];
            let texel = if plain { TEXELS[index % 3] } else { Scalar::Float };
            list[index] = Self { texel, dim, arrayed, shadow: !plain };
            index += 1;
        }
        list
    }

    /// Coordinates that address a texel, without the layer.
    pub fn dimensions(self) -> u8 {
        match self.dim {
            SamplerDim::D1 | SamplerDim::Buffer => 1,
            SamplerDim::D2 | SamplerDim::Rect | SamplerDim::Multisample => 2,
            SamplerDim::D3 | SamplerDim::Cube => 3,
        }
    }

    /// The component of a lookup's `P` that is the reference of a shadow sampler: after the layer, but never the second,
    /// which a 1D shadow leaves unused (§8.7).
    pub fn reference_component(self) -> u8 {
        (self.dimensions() + u8::from(self.arrayed)).max(2)
    }

    /// Whether a texture has levels of detail to choose from: rectangle, buffer and multisample textures have one.
    pub fn has_levels(self) -> bool {
        match self.dim {
            SamplerDim::D1 | SamplerDim::D2 | SamplerDim::D3 | SamplerDim::Cube => true,
            SamplerDim::Rect | SamplerDim::Buffer | SamplerDim::Multisample => false,
        }
    }

    /// Whether texels are filtered or compared: where sampler and texture are apart, such a texture needs a sampler
    /// object. Integers, buffers and multisample textures are only loaded.
    pub fn is_filtered(self) -> bool {
        let one_texel = matches!(self.dim, SamplerDim::Buffer | SamplerDim::Multisample);
        self.texel == Scalar::Float && !one_texel
    }

    /// Whether it is a cube whose texels are only loaded, for which targets have no lookup.
    pub fn is_integer_cube(self) -> bool {
        self.dim == SamplerDim::Cube && !self.is_filtered()
    }

    const fn same(self, other: Self) -> bool {
        self.texel as u8 == other.texel as u8
            && self.dim as u8 == other.dim as u8
            && self.arrayed == other.arrayed
            && self.shadow == other.shadow
    }

    /// The spelling in GLSL: `isampler2DArray`.
    pub fn name(self) -> String {
        let prefix = match self.texel {
            Scalar::Int => "i",
            Scalar::Uint => "u",
            Scalar::Bool | Scalar::Float => "",
        };
        let dim = match self.dim {
            SamplerDim::D1 => "1D",
            SamplerDim::D2 => "2D",
            SamplerDim::D3 => "3D",
            SamplerDim::Cube => "Cube",
            SamplerDim::Rect => "2DRect",
            SamplerDim::Buffer => "Buffer",
            SamplerDim::Multisample => "2DMS",
        };
        let array = if self.arrayed { "Array" } else { "" };
        let shadow = if self.shadow { "Shadow" } else { "" };
        format!("{prefix}sampler{dim}{array}{shadow}")
    }
}

/// The size of an array type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ArraySize {
    /// `[n]`
    Sized(u32),
    /// `[]`. The analysis replaces it, in the variable's type, by the size from the initializer, a redeclaration or
    /// the uses (§4.1.9). It remains only on geometry inputs before their layout is known, and in shaders with
    /// errors.
    Unsized,
}

/// A type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    /// A type in error, which has been reported; it is compatible with everything.
    Error,
    /// `void`
    Void,
    /// `float`
    Scalar(Scalar),
    /// `vec3`: 2 to 4 components.
    Vector(Scalar, u8),
    /// `mat2x3`: columns, rows; always of float.
    Matrix(u8, u8),
    /// `sampler2D`
    Sampler(SamplerType),
    /// `struct S`, and the members of a block.
    Struct(StructId),
    /// `float[3]`
    Array(TypeId, ArraySize),
}

/// The order of a matrix in a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum MatrixLayout {
    #[default]
    ColumnMajor,
    RowMajor,
}

/// The place that the layout of a member of a block asks for (GLSL 4.40 §4.4.1, §4.4.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MemberPlace {
    /// In uniform blocks: `offset = n`, in bytes.
    pub offset: Option<u32>,
    /// In uniform blocks: `align = n`, in bytes; 0 if there is none.
    pub align: u32,
    /// In `in` and `out` blocks: `location = n`.
    pub location: Option<u32>,
    /// In `in` and `out` blocks: `component = n`.
    pub component: Option<u32>,
}

impl MemberPlace {
    /// The offset of a member of a uniform block after one that ends at `end`, for a type with this base alignment:
    /// its own offset or the end, rounded up to a multiple of the greater alignment (4.40 §4.4.5).
    pub fn start(self, end: u32, align: u32) -> u32 {
        let from = self.offset.unwrap_or(end);
        from.checked_next_multiple_of(align.max(self.align).max(1)).unwrap_or(u32::MAX)
    }
}

/// A member of a struct or a block.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Member {
    /// The name.
    pub name: String,
    /// The type.
    pub ty: TypeId,
    /// In uniform blocks: the matrix layout of the member, its own or inherited.
    pub matrix_layout: MatrixLayout,
    /// In `in` and `out` blocks: the member's interpolation.
    pub interpolation: Option<super::Interpolation>,
    /// In `in` and `out` blocks: `centroid` or `sample`.
    pub sampling: super::Sampling,
    /// In `in` and `out` blocks: whether the member is `invariant`.
    pub invariant: bool,
    /// Whether the size of its array follows only from its uses (§4.1.9).
    pub implicitly_sized: bool,
    /// The place that its layout asks for.
    pub place: MemberPlace,
    /// The declaration.
    pub span: crate::source::Span,
}

impl Member {
    /// A member without qualifiers.
    pub fn plain(name: impl Into<String>, ty: TypeId, span: crate::source::Span) -> Self {
        Self {
            name: name.into(),
            ty,
            matrix_layout: MatrixLayout::default(),
            interpolation: None,
            sampling: super::Sampling::Center,
            invariant: false,
            implicitly_sized: false,
            place: MemberPlace::default(),
            span,
        }
    }
}

/// A struct type. Two declarations are two types, whatever their members.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct StructType {
    /// The name; empty for `struct { .. } s;`. For the type of a block, the block's name.
    pub name: String,
    /// The members.
    pub members: Vec<Member>,
    /// Whether this is the type of an interface block.
    pub is_block: bool,
    /// The declaration.
    pub span: crate::source::Span,
}

/// All types of a compilation.
#[derive(Clone, Debug)]
pub struct Types {
    types: Vec<Type>,
    ids: FxHashMap<Type, TypeId>,
    structs: Vec<StructType>,
    /// A summary of each struct's contents, so that nested structs are not traversed again and again.
    summaries: Vec<Option<TypeSummary>>,
}

/// A summary of a type's contents.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TypeSummary {
    /// [`Types::flat_len`]
    flat_len: u32,
    /// Whether it contains a sampler.
    sampler: bool,
    /// Whether it is or contains an array.
    array: bool,
    /// A bit for each [`Scalar`] that it contains.
    scalars: u8,
    /// The depth of nested structs.
    pub(crate) depth: u32,
}

impl TypeSummary {
    fn scalar(scalar: Scalar, flat_len: u32) -> Self {
        Self { flat_len, scalars: 1 << scalar as u8, ..Self::default() }
    }

    fn and(self, other: Self) -> Self {
        Self {
            flat_len: self.flat_len.saturating_add(other.flat_len),
            sampler: self.sampler | other.sampler,
            array: self.array | other.array,
            scalars: self.scalars | other.scalars,
            depth: self.depth.max(other.depth),
        }
    }

    /// Whether it contains a scalar of one of these types.
    pub(crate) fn holds(self, kinds: &[Scalar]) -> bool {
        kinds.iter().any(|&kind| self.scalars & (1 << kind as u8) != 0)
    }
}

// All else follows from these two.
impl PartialEq for Types {
    fn eq(&self, other: &Self) -> bool {
        self.types == other.types && self.structs == other.structs
    }
}

impl Eq for Types {}

impl Hash for Types {
    fn hash<H: Hasher>(&self, state: &mut H) {
        // Basic types are the same in all tables.
        let own = self.types.get(TypeId::FOUR_OFFSETS.index() + 1..).unwrap_or_default();
        (own, &self.structs).hash(state);
    }
}

impl Default for Types {
    fn default() -> Self {
        Self::new()
    }
}

impl TypeId {
    /// The type of something in error, which has been reported; it is compatible with everything.
    pub const ERROR: Self = Self(0);
    /// `void`
    pub const VOID: Self = Self(1);
    /// `bool`
    pub const BOOL: Self = Self::vector(Scalar::Bool, 1);
    /// `int`
    pub const INT: Self = Self::vector(Scalar::Int, 1);
    /// `uint`
    pub const UINT: Self = Self::vector(Scalar::Uint, 1);
    /// `float`
    pub const FLOAT: Self = Self::vector(Scalar::Float, 1);
    /// `vec2`
    pub const VEC2: Self = Self::vector(Scalar::Float, 2);
    /// `vec3`
    pub const VEC3: Self = Self::vector(Scalar::Float, 3);
    /// `vec4`
    pub const VEC4: Self = Self::vector(Scalar::Float, 4);

    /// `ivec2[4]`, the offsets of `textureGatherOffsets`.
    pub const FOUR_OFFSETS: Self = Self(27 + SamplerType::ALL.len() as u32);

    /// The scalar (`size` 1) or vector (2 to 4) type, without a table. Other sizes are clamped.
    pub const fn vector(scalar: Scalar, size: u8) -> Self {
        let size = if size < 1 {
            1
        } else if size > 4 {
            4
        } else {
            size
        };
        Self(2 + scalar as u32 * 4 + size as u32 - 1)
    }

    /// The matrix type with this many columns and rows, without a table. Counts outside 2 to 4 are clamped.
    pub const fn matrix(columns: u8, rows: u8) -> Self {
        let columns = if columns < 2 {
            2
        } else if columns > 4 {
            4
        } else {
            columns
        };
        let rows = if rows < 2 {
            2
        } else if rows > 4 {
            4
        } else {
            rows
        };
        Self(18 + (columns as u32 - 2) * 3 + rows as u32 - 2)
    }

    /// The sampler type, without a table. [`Self::ERROR`] for a combination that GLSL does not have.
    pub const fn sampler(sampler: SamplerType) -> Self {
        let mut index = 0;
        while index < SamplerType::ALL.len() {
            if SamplerType::ALL[index].same(sampler) {
                return Self(27 + index as u32);
            }
            index += 1;
        }
        Self::ERROR
    }

    /// Whether this is the poison type.
    pub fn is_error(self) -> bool {
        self == Self::ERROR
    }

    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

impl Types {
    /// A table of the basic types.
    pub fn new() -> Self {
        let mut types =
            Self { types: Vec::new(), ids: FxHashMap::default(), structs: Vec::new(), summaries: Vec::new() };
        types.intern(Type::Error);
        types.intern(Type::Void);
        for scalar in Scalar::ALL {
            types.intern(Type::Scalar(scalar));
            for size in 2..=4 {
                types.intern(Type::Vector(scalar, size));
            }
        }
        for columns in 2..=4 {
            for rows in 2..=4 {
                types.intern(Type::Matrix(columns, rows));
            }
        }
        for sampler in SamplerType::ALL {
            types.intern(Type::Sampler(sampler));
        }
        types.intern(Type::Array(TypeId::vector(Scalar::Int, 2), ArraySize::Sized(4)));
        types
    }

    /// A shared table of the basic types, whose handles are the same in every table.
    pub fn basic() -> &'static Self {
        static BASIC: std::sync::OnceLock<Types> = std::sync::OnceLock::new();
        BASIC.get_or_init(Self::new)
    }

    /// The handle of a type.
    pub fn intern(&mut self, ty: Type) -> TypeId {
        let next = TypeId(self.types.len() as u32);
        let id = *self.ids.entry(ty).or_insert(next);
        if id == next {
            self.types.push(ty);
        }
        id
    }

    /// All handles, elements before their arrays.
    pub fn ids(&self) -> impl Iterator<Item = TypeId> + use<> {
        (0..self.types.len() as u32).map(TypeId)
    }

    /// The type of a handle of this table.
    pub fn get(&self, id: TypeId) -> Type {
        self.types.get(id.index()).copied().unwrap_or(Type::Error)
    }

    /// Adds a struct and returns its type.
    pub fn add_struct(&mut self, declaration: StructType) -> TypeId {
        let id = StructId(self.structs.len() as u32);
        self.summaries.push(Some(self.summary_of_members(&declaration)));
        self.structs.push(declaration);
        self.intern(Type::Struct(id))
    }

    /// All structs and blocks.
    pub fn structures(&self) -> std::slice::Iter<'_, StructType> {
        self.structs.iter()
    }

    /// The struct of a handle of this table.
    pub fn structure(&self, id: StructId) -> &StructType {
        // Only `add_struct` of this table makes a `StructId`.
        &self.structs[id.0 as usize]
    }

    /// Changes structs, each before those that contain it, so that sizes are those of the members that are left.
    pub fn change_structures(&mut self, mut change: impl FnMut(StructId, &mut StructType)) {
        for index in 0..self.structs.len() {
            let Some(declaration) = self.structs.get_mut(index) else { continue };
            change(StructId(index as u32), declaration);
            let summary = self.structs.get(index).map(|declaration| self.summary_of_members(declaration));
            if let Some(slot) = self.summaries.get_mut(index) {
                *slot = summary;
            }
        }
    }

    /// The struct of a handle, to complete it. What contains it keeps the size that it knows: [`change_structures`](Self::change_structures) is
    /// for other sizes.
    pub fn structure_mut(&mut self, id: StructId) -> &mut StructType {
        self.summaries[id.0 as usize] = None;
        &mut self.structs[id.0 as usize]
    }

    /// `element[size]`
    pub fn array(&mut self, element: TypeId, size: ArraySize) -> TypeId {
        self.intern(Type::Array(element, size))
    }

    /// The component type of a scalar, vector or matrix; `None` for other types.
    pub fn scalar_of(&self, id: TypeId) -> Option<Scalar> {
        match self.get(id) {
            Type::Scalar(scalar) | Type::Vector(scalar, _) => Some(scalar),
            Type::Matrix(..) => Some(Scalar::Float),
            Type::Error | Type::Void | Type::Sampler(_) | Type::Struct(_) | Type::Array(..) => None,
        }
    }

    /// Calls `visit` for each struct in a type, in the order of declaration. It looks into those for which `visit` is true.
    pub fn for_each_struct(&self, id: TypeId, visit: &mut dyn FnMut(StructId) -> bool) {
        match self.get(id) {
            Type::Array(element, _) => self.for_each_struct(element, visit),
            Type::Struct(id) if visit(id) => {
                for member in &self.structure(id).members {
                    self.for_each_struct(member.ty, visit);
                }
            }
            _ => {}
        }
    }

    /// The number of scalars of a value in flat layout: members in order, elements in order, matrices by columns.
    /// Samplers count as one. The number saturates; unsized arrays count 0.
    pub fn flat_len(&self, id: TypeId) -> u32 {
        self.summary(id).flat_len
    }

    /// The summary of a type's contents, without traversing them.
    pub(crate) fn summary(&self, id: TypeId) -> TypeSummary {
        match self.get(id) {
            Type::Error | Type::Void => TypeSummary::default(),
            Type::Scalar(scalar) => TypeSummary::scalar(scalar, 1),
            Type::Sampler(_) => TypeSummary { flat_len: 1, sampler: true, ..TypeSummary::default() },
            Type::Vector(scalar, size) => TypeSummary::scalar(scalar, u32::from(size)),
            Type::Matrix(columns, rows) => TypeSummary::scalar(Scalar::Float, u32::from(columns) * u32::from(rows)),
            Type::Struct(id) => {
                let known = self.summaries.get(id.0 as usize).copied().flatten();
                known.unwrap_or_else(|| self.summary_of_members(self.structure(id)))
            }
            Type::Array(element, size) => {
                let summary = self.summary(element);
                let size = if let ArraySize::Sized(size) = size { size } else { 0 };
                TypeSummary { flat_len: summary.flat_len.saturating_mul(size), array: true, ..summary }
            }
        }
    }

    fn summary_of_members(&self, declaration: &StructType) -> TypeSummary {
        let summaries = declaration.members.iter().map(|member| self.summary(member.ty));
        let summary = summaries.fold(TypeSummary::default(), TypeSummary::and);
        TypeSummary { depth: summary.depth + 1, ..summary }
    }

    /// The type that indexing selects: an array's element, a matrix's column, a vector's component.
    pub fn element(&self, id: TypeId) -> Option<TypeId> {
        match self.get(id) {
            Type::Array(element, _) => Some(element),
            Type::Matrix(_, rows) => Some(TypeId::vector(Scalar::Float, rows)),
            Type::Vector(scalar, _) => Some(TypeId::vector(scalar, 1)),
            Type::Error | Type::Void | Type::Scalar(_) | Type::Sampler(_) | Type::Struct(_) => None,
        }
    }

    /// Whether the type contains a sampler.
    pub fn contains_sampler(&self, id: TypeId) -> bool {
        self.summary(id).sampler
    }

    /// Whether the type is that of a block, or of an array of blocks.
    pub fn is_block(&self, id: TypeId) -> bool {
        match self.get(id) {
            Type::Array(element, _) => self.is_block(element),
            Type::Struct(id) => self.structure(id).is_block,
            _ => false,
        }
    }

    /// Whether the type is a struct that contains an array.
    pub fn is_struct_with_array(&self, id: TypeId) -> bool {
        matches!(self.get(id), Type::Struct(_)) && self.summary(id).array
    }

    /// The spelling in GLSL: `vec4`, `mat2x3`, `Light[2]`.
    pub fn name(&self, id: TypeId) -> String {
        match self.get(id) {
            Type::Error => "<error>".into(),
            Type::Void => "void".into(),
            Type::Scalar(scalar) => scalar.name().into(),
            Type::Vector(scalar, size) => {
                let prefix = match scalar {
                    Scalar::Bool => "b",
                    Scalar::Int => "i",
                    Scalar::Uint => "u",
                    Scalar::Float => "",
                };
                format!("{prefix}vec{size}")
            }
            Type::Matrix(columns, rows) if columns == rows => format!("mat{columns}"),
            Type::Matrix(columns, rows) => format!("mat{columns}x{rows}"),
            Type::Sampler(sampler) => sampler.name(),
            Type::Struct(id) => match self.structure(id).name.as_str() {
                "" => "struct".into(),
                name => name.into(),
            },
            Type::Array(element, size) => {
                let (mut base, mut dims) = (element, vec![size]);
                while let Type::Array(inner, size) = self.get(base) {
                    dims.push(size);
                    base = inner;
                }
                let mut name = self.name(base);
                for dim in dims {
                    match dim {
                        ArraySize::Sized(size) => name.push_str(&format!("[{size}]")),
                        ArraySize::Unsized => name.push_str("[]"),
                    }
                }
                name
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    #[test]
    fn handles_without_a_table_are_those_of_the_table() {
        let mut types = Types::new();
        for sampler in SamplerType::ALL {
            assert_eq!(types.intern(Type::Sampler(sampler)), TypeId::sampler(sampler), "{}", sampler.name());
        }
        assert_eq!(types.intern(Type::Matrix(4, 2)), TypeId::matrix(4, 2));
        assert_eq!(types.intern(Type::Vector(Scalar::Uint, 3)), TypeId::vector(Scalar::Uint, 3));
    }

    #[test]
    fn a_struct_knows_the_size_of_one_that_it_contains() {
        let mut types = Types::new();
        let members = |names: &[&str], ty| names.iter().map(|name| Member::plain(*name, ty, Span::default())).collect();
        let of =
            |name: &str, members| StructType { name: name.to_owned(), members, is_block: false, span: Span::default() };
        let inner = types.add_struct(of("Inner", members(&["a", "b"], TypeId::VEC4)));
        let three = types.array(inner, ArraySize::Sized(3));
        let outer = types.add_struct(of("Outer", members(&["c"], three)));
        assert_eq!(types.flat_len(outer), 24);
        types.change_structures(|_, declaration| declaration.members.truncate(1));
        assert_eq!((types.flat_len(inner), types.flat_len(outer)), (4, 12));
    }
}
