//! Compiles and links programs with the driver.
//!
//! *In:* a program's texts and the locations of its attributes and outputs. *Out:* a program object of the driver.

use super::api::Api;
use super::{Error, Gl};
use glisten_front::hir::Stage;
use glisten_front::link::Program;

/// Compiles and links the texts of a program.
pub(super) fn link(api: &Api, program: &Program, generated: Option<Stage>) -> Result<glow::Program, Error> {
    let linked = api.create_program().map_err(Error::Refused)?;
    // The driver's fixed-function pipeline provides a stage that the scene does not name.
    for shader in program.stages.iter().filter(|shader| Some(shader.stage) != generated) {
        for text in &shader.texts {
            api.attach_shader(linked, compile(api, &program.name, shader.stage, text)?);
        }
    }
    for attribute in program.interface.attributes.iter().filter(|attribute| !attribute.name.starts_with("gl_")) {
        api.bind_attrib_location(linked, attribute.location + first_location(api), &attribute.name);
    }
    // `gl_FragColor` and the other built-in outputs have fixed color numbers.
    for output in program.interface.outputs.iter().filter(|output| !output.name.starts_with("gl_")) {
        api.bind_frag_data_location(linked, output.location, &output.name);
    }
    api.link_program(linked);
    if !api.get_program_link_status(linked) {
        return Err(Error::Link { program: program.name.clone(), log: api.get_program_info_log(linked) });
    }
    api.check("linking")?;
    Ok(linked)
}

/// The location of the first attribute. In a compatibility context, location 0 is that of `gl_Vertex`.
pub(super) fn first_location(api: &Api) -> u32 {
    u32::from(api.old().is_some())
}

impl Gl {
    /// Whether the driver's compiler accepts these texts, and its linker the program of them if they have a vertex and a
    /// fragment stage. The context is one with the fixed-function pipeline, which takes the texts of every version.
    ///
    /// # Errors
    /// The driver's log.
    pub fn accept(&self, name: &str, texts: &[(Stage, &str)]) -> Result<(), Error> {
        let context = self.context(true)?;
        let api = context.api();
        let linked = api.create_program().map_err(Error::Refused)?;
        for (stage, text) in texts {
            api.attach_shader(linked, compile(api, name, *stage, text)?);
        }
        let has = |wanted| texts.iter().any(|(stage, _)| *stage == wanted);
        if has(Stage::Vertex) && has(Stage::Fragment) {
            api.link_program(linked);
            if !api.get_program_link_status(linked) {
                return Err(Error::Link { program: name.to_owned(), log: api.get_program_info_log(linked) });
            }
        }
        Ok(())
    }
}

fn compile(api: &Api, program: &str, stage: Stage, text: &str) -> Result<glow::Shader, Error> {
    let kind = match stage {
        Stage::Vertex => glow::VERTEX_SHADER,
        Stage::Geometry => glow::GEOMETRY_SHADER,
        Stage::Fragment => glow::FRAGMENT_SHADER,
    };
    let compiled = api.create_shader(kind).map_err(Error::Refused)?;
    api.shader_source(compiled, text);
    api.compile_shader(compiled);
    if api.get_shader_compile_status(compiled) {
        Ok(compiled)
    } else {
        let log = api.get_shader_info_log(compiled);
        Err(Error::Compile { program: program.to_owned(), stage, log })
    }
}
