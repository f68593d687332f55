//! The roles of matrices, and the uniforms that take them.

use super::words::forms;
use glisten_front::hir::{Scalar, Type};

/// The matrix or position that a uniform gets from the camera and the transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum MatrixRole {
    Model,
    View,
    Projection,
    ModelView,
    ViewProjection,
    ModelViewProjection,
    ModelInverse,
    ViewInverse,
    ProjectionInverse,
    ModelViewInverse,
    ViewProjectionInverse,
    ModelViewProjectionInverse,
    /// The inverse transpose of the upper left 3x3 of the model-view matrix.
    Normal,
    /// The inverse transpose of the upper left 3x3 of the model matrix.
    ModelNormal,
    /// The camera's position in world space.
    Eye,
}

use MatrixRole::{
    Eye, Model, ModelInverse, ModelNormal, ModelView, ModelViewInverse, ModelViewProjection,
    ModelViewProjectionInverse, Normal, Projection, ProjectionInverse, View, ViewInverse, ViewProjection,
    ViewProjectionInverse,
};

impl MatrixRole {
    /// The names in `[draw.matrices]`.
    pub const NAMES: &[(&str, Self)] = &[
        ("model", Model),
        ("view", View),
        ("projection", Projection),
        ("model_view", ModelView),
        ("view_projection", ViewProjection),
        ("model_view_projection", ModelViewProjection),
        ("normal", Normal),
        ("model_normal", ModelNormal),
        ("eye", Eye),
        ("model_inverse", ModelInverse),
        ("view_inverse", ViewInverse),
        ("projection_inverse", ProjectionInverse),
        ("model_view_inverse", ModelViewInverse),
        ("view_projection_inverse", ViewProjectionInverse),
        ("model_view_projection_inverse", ModelViewProjectionInverse),
    ];

    /// The name in `[draw.matrices]`.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, role)| *role == self).map_or("model", |(name, _)| name)
    }

    /// Whether a uniform of this type can take it. A `mat4` for normals has the 3x3 in its upper left.
    pub fn fits(self, ty: Type) -> bool {
        match self {
            Eye => ty == Type::Vector(Scalar::Float, 3),
            Normal | ModelNormal => matches!(ty, Type::Matrix(3, 3) | Type::Matrix(4, 4)),
            _ => ty == Type::Matrix(4, 4),
        }
    }

    fn inverse(self) -> Option<Self> {
        match self {
            Model => Some(ModelInverse),
            View => Some(ViewInverse),
            Projection => Some(ProjectionInverse),
            ModelView => Some(ModelViewInverse),
            ViewProjection => Some(ViewProjectionInverse),
            ModelViewProjection => Some(ModelViewProjectionInverse),
            _ => None,
        }
    }
}

/// Words that say nothing about the role.
static AFFIXES: &[&str] = &[
    "u", "un", "uni", "uniform", "g", "gl", "ci", "osg", "iris", "in", "the", "my", "cb", "c", "matrix", "mat", "mtx",
    "k", "xf", "current",
];

/// The names of each role without such words.
static NAMES: &[(MatrixRole, &[&str])] = &[
    (
        Model,
        &[
            "m",
            "model",
            "world",
            "w",
            "modelworld",
            "modeltoworld",
            "objecttoworld",
            "object2world",
            "localtoworld",
            "modeltransform",
            "modelling",
            "modeling",
            "modeltransformation",
            "worldtransform",
            "entitymodel",
            "m2w",
        ],
    ),
    (
        View,
        &[
            "v",
            "view",
            "camera",
            "cam",
            "cameraview",
            "camview",
            "worldtoview",
            "worldtocamera",
            "world2view",
            "viewtransform",
            "lookat",
            "worldtoeye",
            "viewing",
            "gbuffermodelview",
            "gbufferpreviousmodelview",
        ],
    ),
    (
        Projection,
        &[
            "p",
            "proj",
            "projection",
            "perspective",
            "cameraprojection",
            "camproj",
            "viewtoclip",
            "p3dprojection",
            "gbufferprojection",
            "gbufferpreviousprojection",
            "projectiontransform",
        ],
    ),
    (
        ModelView,
        &[
            "mv",
            "modelview",
            "worldview",
            "wv",
            "modeltoview",
            "objecttoview",
            "modeltoeye",
            "p3dmodelview",
            "vm",
            "viewmodel",
        ],
    ),
    (
        ViewProjection,
        &[
            "vp",
            "viewproj",
            "viewprojection",
            "pv",
            "projview",
            "projectionview",
            "worldtoclip",
            "cameraviewprojection",
            "cameraviewproj",
            "viewpersp",
        ],
    ),
    (
        ModelViewProjection,
        &[
            "mvp",
            "modelviewproj",
            "modelviewprojection",
            "worldviewproj",
            "worldviewprojection",
            "wvp",
            "pvm",
            "projectionviewmodel",
            "projmodelview",
            "projectionmodelview",
            "projviewmodel",
            "modeltoclip",
            "objecttoclip",
            "p3dmodelviewprojection",
            "modelviewpersp",
            "modelviewperspective",
        ],
    ),
    (
        Normal,
        &["n", "nm", "normal", "normals", "modelviewit", "worldviewit", "normaltransform", "p3dnormal", "normaltoview"],
    ),
    (
        ModelNormal,
        &[
            "modelnormal",
            "worldnormal",
            "modelit",
            "worldit",
            "worldinversetranspose",
            "modelinversetranspose",
            "normalworld",
            "normaltoworld",
            "normalmodel",
        ],
    ),
    (
        Eye,
        &[
            "eye",
            "eyepos",
            "eyeposition",
            "eyepoint",
            "eyeworld",
            "eyepositionworldspace",
            "eyepositionworld",
            "camera",
            "camerapos",
            "cameraposition",
            "campos",
            "camposition",
            "cameraworldpos",
            "camerapositionworldspace",
            "worldcamerapos",
            "worldspacecamerapos",
            "cameraorigin",
            "viewpos",
            "viewposition",
            "viewerpos",
            "viewerposition",
            "vieweye",
            "viewer",
            "worldeyepos",
            "worldeyeposition",
            "worldviewpos",
            "cameraeye",
            "cameralocation",
            "wseye",
            "p3dcameraposition",
        ],
    ),
];

/// Whole names that mean something else than their words.
static WHOLE: &[(&str, MatrixRole)] = &[("matNormal", ModelNormal), ("_World2Object", ModelInverse)];

/// The role that the name and the type of a uniform say.
pub fn matrix_role(name: &str, ty: Type) -> Option<MatrixRole> {
    let whole = WHOLE.iter().find(|(known, _)| *known == name).map(|(_, role)| *role);
    whole.or_else(|| by_words(name, ty)).filter(|role| role.fits(ty))
}

fn by_words(name: &str, ty: Type) -> Option<MatrixRole> {
    forms(name, AFFIXES).iter().find_map(|form| {
        // Hungarian: a member or a matrix.
        let forms = [form.as_str(), form.strip_prefix('m').unwrap_or("")];
        forms.into_iter().find_map(|form| {
            let plain = find(form, ty);
            let inverse = || ["inverse", "inv", "i"].iter().find_map(|word| inverse_of(form, word, ty));
            plain.or_else(inverse)
        })
    })
}

fn find(form: &str, ty: Type) -> Option<MatrixRole> {
    let shorter = ["matrix", "mat"].iter().find_map(|end| form.strip_suffix(end)).unwrap_or(form);
    let rows = NAMES.iter().filter(|(role, _)| role.fits(ty));
    rows.clone().find(|(_, names)| names.contains(&form) || names.contains(&shorter)).map(|(role, _)| *role)
}

fn inverse_of(form: &str, word: &str, ty: Type) -> Option<MatrixRole> {
    let rest = form.strip_prefix(word).or_else(|| form.strip_suffix(word))?;
    find(rest, ty)?.inverse()
}

/// Whether a name says no more than that the matrix transforms: all the way, if the program has no other one.
pub fn is_plain_transform(name: &str) -> bool {
    const NAMES: &[&str] =
        &["transform", "transformation", "trans", "xform", "trafo", "matrix", "mat", "modelviewprojectionmatrix"];
    forms(name, &["u", "m", "g", "the", "matrix", "mat"]).iter().any(|form| NAMES.contains(&form.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_engines_say_their_role() {
        let rows: &[(MatrixRole, &str)] = &[
            (
                Model,
                "M model u_model uModelMatrix u_modelMatrix matModel ciModelMatrix world World _Object2World ModelMatrix m",
            ),
            (View, "V view u_view viewMatrix matView view_mat viewmatrix ciViewMatrix osg_ViewMatrix gbufferModelView"),
            (
                Projection,
                "P proj projection u_projectionMatrix ProjMat projectionMatrix p3d_ProjectionMatrix projmatrix matProjection \
                 osg_ProjectionMatrix gbufferProjection iris_ProjMat",
            ),
            (
                ModelView,
                "MV modelView ModelViewMat u_modelViewMatrix modelviewMatrix worldView p3d_ModelViewMatrix uWorldView \
                 osg_ModelViewMatrix ciModelView gl_ModelViewMatrix modelview_matrix",
            ),
            (ViewProjection, "VP viewProj uViewProjection u_viewProjectionMatrix viewProjMatrix ciViewProjection"),
            (
                ModelViewProjection,
                "MVP mvp u_mvp uMvpMatrix MVPMatrix modelViewProjection u_MVPMatrix worldViewProj mvp_matrix \
                 worldviewproj_matrix g_mWorldViewProjection p3d_ModelViewProjectionMatrix ciModelViewProjection WorldViewProj \
                 ModelViewProjMat worldViewProjMatrix modelViewProjectionMatrix cWorldViewProj gl_ModelViewProjectionMatrix",
            ),
            (
                ViewInverse,
                "inverseView invView osg_ViewMatrixInverse gbufferModelViewInverse viewInverse viewMatrixInverse",
            ),
            (ProjectionInverse, "u_inverseProjectionMatrix gbufferProjectionInverse projInv invProj"),
            (Normal, "normalMatrix u_normalMatrix N NormalMatrix ciNormalMatrix p3d_NormalMatrix gl_NormalMatrix"),
            (ModelNormal, "matNormal worldIT modelInverseTranspose"),
        ];
        for (role, names) in rows {
            for name in names.split_whitespace() {
                assert_eq!(matrix_role(name, Type::Matrix(4, 4)), Some(*role), "{name}");
            }
        }
        for name in "eye viewPos camPos eyePosition view_position uEyePos cameraPos _WorldSpaceCameraPos u_Camera"
            .split_whitespace()
        {
            assert_eq!(matrix_role(name, Type::Vector(Scalar::Float, 3)), Some(Eye), "{name}");
        }
        assert_eq!(matrix_role("normalMatrix", Type::Matrix(3, 3)), Some(Normal));
    }

    #[test]
    fn other_matrices_have_no_role() {
        for name in "lightSpaceMatrix uShadowMatrix TextureMat texMatrix bones lightVP shadowModelView u_biasMatrix a b"
            .split_whitespace()
        {
            assert_eq!(matrix_role(name, Type::Matrix(4, 4)), None, "{name}");
        }
        assert_eq!(matrix_role("view", Type::Matrix(3, 3)), None);
        assert_eq!(matrix_role("M", Type::Scalar(Scalar::Float)), None);
        assert!(is_plain_transform("transform") && is_plain_transform("uMatrix") && !is_plain_transform("lightMatrix"));
    }
}
