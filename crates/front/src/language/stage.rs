//! [`Stage`], and how variables are stored, interpolated and passed in each of them.

/// A stage of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Stage {
    Vertex,
    Geometry,
    Fragment,
}

impl Stage {
    /// All stages in the order of the pipeline.
    pub const ALL: [Self; 3] = [Self::Vertex, Self::Geometry, Self::Fragment];

    /// `vertex`, `geometry`, `fragment`
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Geometry => "geometry",
            Self::Fragment => "fragment",
        }
    }
}

/// How a varying is interpolated (§4.3.9).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Interpolation {
    /// Perspective-correct.
    #[default]
    Smooth,
    /// Linear in window space.
    Noperspective,
    /// The value at the provoking vertex.
    Flat,
}

impl Interpolation {
    /// `smooth`, `noperspective`, `flat`
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Noperspective => "noperspective",
            Self::Flat => "flat",
        }
    }
}

/// Where in a pixel a varying is evaluated: the auxiliary storage qualifiers (§4.3.9; GLSL 4.00 §4.3.4, §4.3.6).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sampling {
    /// At the center, or anywhere in the pixel.
    #[default]
    Center,
    /// Inside of the pixel and of the primitive.
    Centroid,
    /// At each sample, for each of which the fragment shader then runs.
    Sample,
}

impl Sampling {
    /// The qualifier: `centroid`, `sample`.
    pub fn word(self) -> Option<&'static str> {
        match self {
            Self::Center => None,
            Self::Centroid => Some("centroid"),
            Self::Sample => Some("sample"),
        }
    }

    /// The qualifier with a space behind it, or nothing.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Center => "",
            Self::Centroid => "centroid ",
            Self::Sample => "sample ",
        }
    }
}

/// The precision of a variable in ES (GLSL ES 3.00 §4.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// `lowp`
    Low,
    /// `mediump`
    Medium,
    /// `highp`
    High,
}

impl Precision {
    /// The qualifier.
    pub fn word(self) -> &'static str {
        match self {
            Self::Low => "lowp",
            Self::Medium => "mediump",
            Self::High => "highp",
        }
    }
}

/// The storage of a global (§4.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Storage {
    /// `const`
    Const,
    /// No qualifier: a variable of each invocation.
    Private,
    /// `uniform`, samplers included.
    Uniform,
    /// `in`, `attribute`, fragment-side `varying`.
    In,
    /// `out`, vertex-side `varying`.
    Out,
}

/// How a parameter is passed (§6.1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum ParamMode {
    In,
    ConstIn,
    Out,
    Inout,
}
