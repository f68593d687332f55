//! The roles of a mesh's data, and the attributes that take them.

use super::words::forms;
use glisten_front::hir::{Scalar, Type};

/// The meaning of a mesh's data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum AttributeRole {
    Position,
    Normal,
    Texcoord,
    /// A second set of texture coordinates.
    Texcoord2,
    Color,
    /// The direction of growing s, and in w the handedness of the bitangent: 1 or -1.
    Tangent,
    Bitangent,
}

use AttributeRole::{Bitangent, Color, Normal, Position, Tangent, Texcoord, Texcoord2};

impl AttributeRole {
    /// All roles.
    pub const ALL: [Self; 7] = [Position, Normal, Texcoord, Texcoord2, Color, Tangent, Bitangent];

    /// The key of `[draw.mesh]`.
    pub fn name(self) -> &'static str {
        match self {
            Position => "position",
            Normal => "normal",
            Texcoord => "texcoord",
            Texcoord2 => "texcoord2",
            Color => "color",
            Tangent => "tangent",
            Bitangent => "bitangent",
        }
    }

    /// The attribute of the fixed-function pipeline.
    pub fn fixed_attribute(self) -> Option<&'static str> {
        match self {
            Position => Some("gl_Vertex"),
            Normal => Some("gl_Normal"),
            Texcoord => Some("gl_MultiTexCoord0"),
            Color => Some("gl_Color"),
            Texcoord2 | Tangent | Bitangent => None,
        }
    }

    /// Whether an attribute of this type can take the data.
    pub fn fits(self, ty: Type) -> bool {
        let Type::Vector(Scalar::Float, size) = ty else { return false };
        match self {
            Position | Texcoord | Texcoord2 => true,
            Normal | Color | Tangent | Bitangent => size >= 3,
        }
    }
}

/// Words that say nothing about the role: whose the attribute is, which stage takes it, which space it is in.
static AFFIXES: &[&str] = &[
    "a",
    "attr",
    "attrib",
    "attribute",
    "ci",
    "data",
    "geom",
    "gl",
    "i",
    "in",
    "input",
    "iris",
    "l",
    "local",
    "localspace",
    "m",
    "mc",
    "mesh",
    "model",
    "modelspace",
    "ms",
    "my",
    "o",
    "obj",
    "object",
    "objectspace",
    "os",
    "osg",
    "p3d",
    "p",
    "3",
    "d",
    "piglit",
    "qt",
    "raw",
    "rm",
    "s",
    "the",
    "v",
    "va",
    "vert",
    "vertex",
    "vs",
    "vtx",
    "xl",
    "0",
];

/// The names of each role without such words.
static NAMES: &[(AttributeRole, &[&str])] = &[
    (
        Position,
        &[
            "position",
            "positions",
            "pos",
            "point",
            "xyz",
            "vertex",
            "vertices",
            "vert",
            "vertexpos",
            "vertexposition",
            "vertexcoord",
            "vertexpoint",
            "coord3d",
            "location",
        ],
    ),
    (Normal, &["normal", "normals", "norm", "nrm", "nrml", "vertexnormal", "normaldir"]),
    (
        Texcoord,
        &[
            "texcoord",
            "texcoords",
            "texcord",
            "texturecoord",
            "texturecoords",
            "texturecoordinate",
            "texturecoordinates",
            "texcoordinate",
            "texcoordinates",
            "textureuv",
            "texuv",
            "uv",
            "uvs",
            "uvcoord",
            "uvcoords",
            "uvmap",
            "st",
            "tex",
            "tc",
            "tcoord",
            "multitexcoord",
            "vertexuv",
            "vertextexcoord",
            "maincoord",
            "diffuseuv",
            "coord2d",
        ],
    ),
    (
        Color,
        &["color", "colour", "colors", "colours", "col", "rgb", "rgba", "vertexcolor", "vertexcolour", "diffusecolor"],
    ),
    (Bitangent, &["bitangent", "bitangents", "binormal", "binormals", "bitang", "bitan", "binorm"]),
    (Tangent, &["tangent", "tangents", "tang", "tan", "vertextangent"]),
];

/// The role that the name of an attribute says unmistakably, if its type can take the data.
pub fn attribute_role(name: &str, ty: Type) -> Option<AttributeRole> {
    let forms = forms(name, AFFIXES);
    let has = |names: &[&str]| forms.iter().any(|form| names.contains(&form.as_str()));
    let named = NAMES.iter().find(|(_, names)| has(names)).map(|(role, _)| *role);
    named.or_else(|| by_type(&forms, ty)).filter(|role| role.fits(ty))
}

/// A coordinate is one of the texture if it has two components, and otherwise a position.
fn by_type(forms: &[String], ty: Type) -> Option<AttributeRole> {
    let Type::Vector(_, size) = ty else { return None };
    let coordinate = forms.iter().any(|form| ["coord", "coords", "coordinate", "coordinates"].contains(&form.as_str()));
    coordinate.then_some(if size == 2 { Texcoord } else { Position })
}

/// Parts of names that suggest a role. The first one that fits counts.
static PARTS: &[(AttributeRole, &[&str])] = &[
    (Bitangent, &["bitan", "binorm"]),
    (Tangent, &["tang"]),
    (Normal, &["norm", "nrm"]),
    (Texcoord, &["uv", "tex", "coord"]),
    (Color, &["col"]),
    (Position, &["pos", "vert", "point"]),
];

/// Short names.
static SHORT: &[(AttributeRole, &[&str])] = &[
    (Position, &["p", "v", "vp", "pv", "pt", "vtx"]),
    (Normal, &["n", "vn", "nv"]),
    (Texcoord, &["t", "vt", "tv", "st"]),
    (Color, &["c", "vc", "cv"]),
];

/// The role that the name suggests, and that its type can take.
pub fn likely_attribute_role(name: &str, ty: Type) -> Option<AttributeRole> {
    let small = name.to_ascii_lowercase();
    let short = SHORT.iter().find(|(_, names)| names.contains(&small.as_str()));
    let part = PARTS.iter().find(|(role, parts)| role.fits(ty) && parts.iter().any(|part| small.contains(part)));
    attribute_role(name, ty).or_else(|| short.or(part).map(|(role, _)| *role)).filter(|role| role.fits(ty))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(size: u8) -> Type {
        Type::Vector(Scalar::Float, size)
    }

    #[test]
    fn names_of_engines_say_their_role() {
        let rows: &[(AttributeRole, u8, &str)] = &[
            (
                Position,
                3,
                "position a_position aPos aPosition in_position inPosition i_position VertexPosition vertexPosition_modelspace \
                 vertex_position gl_Vertex osg_Vertex p3d_Vertex vPosition v_position pos in_pos Position vertex a_vertex vert \
                 MCvertex MCVertex piglit_vertex ciPosition VertexCoord mcoord vertexPos attr_pos a_pos coord3d",
            ),
            (
                Normal,
                3,
                "normal aNormal a_normal vNormal v_normal in_normal inNormal Normal vertexNormal vertex_normal \
                 vertexNormal_modelspace osg_Normal p3d_Normal gl_Normal ciNormal norm nrm MCnormal",
            ),
            (
                Texcoord,
                2,
                "texcoord aTexCoord aTexCoords a_texcoord0 a_texCoord in_UV UV UV0 uv st TexCoord texCoords vertexUV \
                 vertexTexCoord vertTexCoord0 texture_coord texture_coordinates osg_MultiTexCoord0 p3d_MultiTexCoord0 \
                 gl_MultiTexCoord0 ciTexCoord0 tex_coord Texcoord a_uv vTexCoord inTexCoord",
            ),
            (
                Color,
                4,
                "color aColor a_color Color vertexColor vertex_colour colour vcolor in_color inVertexColor p3d_Color \
                 ciColor osg_Color gl_Color",
            ),
            (Tangent, 3, "tangent aTangent vertexTangent vertexTangent_modelspace a_tangent p3d_Tangent"),
            (Bitangent, 3, "bitangent binormal aBitangent vertexBitangent_modelspace a_binormal p3d_Binormal"),
        ];
        for (role, size, names) in rows {
            for name in names.split_whitespace() {
                assert_eq!(attribute_role(name, vector(*size)), Some(*role), "{name}");
            }
        }
    }

    #[test]
    fn other_names_and_other_types_say_none() {
        for name in [
            "UV1",
            "texcoord2",
            "position2",
            "weights",
            "offset",
            "foo",
            "pv",
            "vp",
            "scale",
            "fragPosition",
            "boneIds",
        ] {
            assert_eq!(attribute_role(name, vector(3)), None, "{name}");
        }
        assert_eq!(attribute_role("position", Type::Vector(Scalar::Int, 3)), None);
        assert_eq!(attribute_role("normal", vector(2)), None);
        assert_eq!(attribute_role("color", Type::Scalar(Scalar::Float)), None);
    }

    #[test]
    fn parts_and_short_names_suggest_a_role() {
        for (name, size, role) in [
            ("vp", 3, Position),
            ("pv", 4, Position),
            ("vn", 3, Normal),
            ("tv", 2, Texcoord),
            ("cv", 4, Color),
            ("UV1", 2, Texcoord),
            ("my_normal_2", 3, Normal),
            ("positionB", 3, Position),
        ] {
            assert_eq!(likely_attribute_role(name, vector(size)), Some(role), "{name}");
        }
        assert_eq!(likely_attribute_role("offset", vector(3)), None);
    }
}
