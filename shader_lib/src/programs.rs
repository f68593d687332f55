//! The programs of the library: pairs of shaders in `shader_lib/programs`, made of its modules.
//!
//! *In:* the embedded files. *Out:* [`programs`] by name, [`shader`] by file name.
//!
//! *Holds:* vertex inputs are called `position`, `normal` and `texcoord`, and matrices have the names of the roles in
//! a scene's `[draw.matrices]`, so that a scene need not name them. The textbook's own programs keep the textbook's
//! names.

/// A program of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LibraryProgram {
    /// The name: `hemi_spec`.
    pub name: &'static str,
    /// The file of its vertex shader.
    pub vertex: &'static str,
    /// The file of its fragment shader.
    pub fragment: &'static str,
    /// A description: what it draws, and from which document.
    pub about: &'static str,
}

macro_rules! shader {
    ($name:literal) => {
        ($name, include_str!(concat!("../programs/", $name)))
    };
}

static SHADERS: &[(&str, &str)] = &[
    shader!("blinn_phong.frag"),
    shader!("blinn_phong_vertex.vert"),
    shader!("corner.frag"),
    shader!("cosine.frag"),
    shader!("cosine.vert"),
    shader!("decal.frag"),
    shader!("decal.vert"),
    shader!("dial.frag"),
    shader!("diffuse.frag"),
    shader!("diffuse.vert"),
    shader!("drawing.frag"),
    shader!("edge.frag"),
    shader!("edge.vert"),
    shader!("ember.frag"),
    shader!("furnace.frag"),
    shader!("hemi_amb.vert"),
    shader!("hemi_spec.vert"),
    shader!("hemisphere.vert"),
    shader!("lambert.frag"),
    shader!("lambert_vertex.vert"),
    shader!("lamps.frag"),
    shader!("lux.frag"),
    shader!("mist.frag"),
    shader!("noises.frag"),
    shader!("page.vert"),
    shader!("pan.frag"),
    shader!("panels.frag"),
    shader!("phong.frag"),
    shader!("phong_vertex.vert"),
    shader!("probe.frag"),
    shader!("schlick.frag"),
    shader!("schlick_vertex.vert"),
    shader!("shade.frag"),
    shader!("shadows.frag"),
    shader!("soft.frag"),
    shader!("soft.vert"),
    shader!("specular.frag"),
    shader!("specular.vert"),
    shader!("standard.frag"),
    shader!("standard.vert"),
    shader!("standard_vertex.frag"),
    shader!("standard_vertex.vert"),
    shader!("studio.frag"),
    shader!("surface.vert"),
    shader!("texspec.frag"),
    shader!("texspec.vert"),
    shader!("threshold.frag"),
    shader!("threshold_vertex.vert"),
    shader!("tones.frag"),
    shader!("vertex_color.frag"),
    shader!("vertex_color.vert"),
    shader!("vertex_color_flat.frag"),
    shader!("vertex_color_flat.vert"),
    shader!("vertex_color_noperspective.frag"),
    shader!("vertex_color_noperspective.vert"),
];

const fn program(
    name: &'static str,
    vertex: &'static str,
    fragment: &'static str,
    about: &'static str,
) -> LibraryProgram {
    LibraryProgram { name, vertex, fragment, about }
}

static PROGRAMS: &[LibraryProgram] = &[
    program("blinn_phong", "surface.vert", "blinn_phong.frag", "textbook, (101) with (83) and (89), at each fragment"),
    program(
        "blinn_phong_vertex",
        "blinn_phong_vertex.vert",
        "shade.frag",
        "textbook, (101) with (83) and (89), at each vertex",
    ),
    program("corner", "surface.vert", "corner.frag", "a corner of a room with balls, under light from everywhere"),
    program(
        "cosine",
        "cosine.vert",
        "cosine.frag",
        "textbook, figure 127: powers of a cosine and the normal distribution",
    ),
    program("decal", "decal.vert", "decal.frag", "article, its ground and sky: a color times a texture, unlit"),
    program("dial", "page.vert", "dial.frag", "a clock of distances, whose edges are smooth"),
    program("diffuse", "diffuse.vert", "diffuse.frag", "article: parallel light and constant ambient light"),
    program("drawing", "surface.vert", "drawing.frag", "a technical drawing, from cool to warm"),
    program("edge", "edge.vert", "edge.frag", "article: the outline, drawn before the model"),
    program("ember", "surface.vert", "ember.frag", "a surface that burns away, lit by the picture of a ball"),
    program(
        "furnace",
        "surface.vert",
        "furnace.frag",
        "a white metal in a white room, with and without later reflections",
    ),
    program("hemi_amb", "hemi_amb.vert", "diffuse.frag", "article: parallel light over half spheres"),
    program(
        "hemi_spec",
        "hemi_spec.vert",
        "specular.frag",
        "article: parallel light over half spheres, and a highlight",
    ),
    program("hemisphere", "hemisphere.vert", "diffuse.frag", "article: light from two half spheres"),
    program("lambert", "surface.vert", "lambert.frag", "textbook, (101) with (83), at each fragment"),
    program("lambert_vertex", "lambert_vertex.vert", "shade.frag", "textbook, (101) with (83), at each vertex"),
    program("lamps", "surface.vert", "lamps.frag", "microfacets under a sphere and a tube of light"),
    program("lux", "surface.vert", "lux.frag", "a diffuse surface under three lamps with profiles, in lux"),
    program("metal", "texspec.vert", "texspec.frag", "article: `texspec` with a mottled pattern for its texture"),
    program("mist", "surface.vert", "mist.frag", "Lambert in fog that lies on the ground"),
    program("noises", "surface.vert", "noises.frag", "solid textures of noise, lit"),
    program("pan", "surface.vert", "pan.frag", "a pan brushed in circles, under two lamps"),
    program("panels", "surface.vert", "panels.frag", "microfacets under a rectangle of light"),
    program("phong", "surface.vert", "phong.frag", "textbook, (101) with (83) and (86), at each fragment"),
    program("phong_vertex", "phong_vertex.vert", "shade.frag", "textbook, (101) with (83) and (86), at each vertex"),
    program("probe", "surface.vert", "probe.frag", "light from all around by spherical harmonics"),
    program("schlick", "surface.vert", "schlick.frag", "textbook, (101) with (83) and (90), at each fragment"),
    program(
        "schlick_vertex",
        "schlick_vertex.vert",
        "shade.frag",
        "textbook, (101) with (83) and (90), at each vertex",
    ),
    program("shadows", "surface.vert", "shadows.frag", "four shadows of a map, under a sun and a sky"),
    program("soft", "soft.vert", "soft.frag", "article: toon shading with a soft edge"),
    program(
        "specular",
        "specular.vert",
        "specular.frag",
        "article: a highlight by color, the fourth power of a cosine",
    ),
    program("standard", "standard.vert", "standard.frag", "(101) with any lights and any models, at each fragment"),
    program(
        "standard_vertex",
        "standard_vertex.vert",
        "standard_vertex.frag",
        "(101) with any lights and any models, at each vertex",
    ),
    program("studio", "surface.vert", "studio.frag", "microfacets under a prefiltered panorama"),
    program("texspec", "texspec.vert", "texspec.frag", "article: a highlight by texture"),
    program("threshold", "surface.vert", "threshold.frag", "textbook, (101) with (83) and (91), at each fragment"),
    program(
        "threshold_vertex",
        "threshold_vertex.vert",
        "shade.frag",
        "textbook, (101) with (83) and (91), at each vertex",
    ),
    program("tones", "page.vert", "tones.frag", "six tone curves over all hues and ten stops"),
    program(
        "vertex_color",
        "vertex_color.vert",
        "vertex_color.frag",
        "textbook, section 10.2.4: a color at each vertex",
    ),
    program("vertex_color_flat", "vertex_color_flat.vert", "vertex_color_flat.frag", "the same, not interpolated"),
    program(
        "vertex_color_noperspective",
        "vertex_color_noperspective.vert",
        "vertex_color_noperspective.frag",
        "the same, interpolated linearly on the screen",
    ),
];

/// All programs, by name.
pub fn programs() -> &'static [LibraryProgram] {
    PROGRAMS
}

/// The text of a shader, by the name of its file: `standard.frag`.
pub fn shader(file: &str) -> Option<&'static str> {
    SHADERS.iter().find(|(name, _)| *name == file).map(|(_, text)| *text)
}

/// The file names of all shaders, sorted.
pub fn shader_files() -> impl Iterator<Item = &'static str> {
    SHADERS.iter().map(|(name, _)| *name)
}

#[cfg(test)]
mod tests {
    use super::{programs, shader, shader_files};
    use std::path::Path;

    #[test]
    fn every_shader_is_embedded_and_used() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .expect("the folder is there")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        files.sort();
        assert_eq!(files, shader_files().collect::<Vec<_>>());
        for file in files {
            assert!(programs().iter().any(|program| program.vertex == file || program.fragment == file), "{file}");
        }
    }

    #[test]
    fn programs_are_sorted_and_their_files_are_there() {
        assert!(programs().is_sorted_by(|a, b| a.name < b.name));
        for program in programs() {
            assert!(shader(program.vertex).is_some() && shader(program.fragment).is_some(), "{}", program.name);
        }
    }
}
