//! Draws scenes by OpenGL, if that backend is built in.

use crate::exit::Failure;
use crate::scenes::{DrawError, MachineArgs};
use glisten_scene::picture::Picture;
use glisten_verify::scene::Scene;

#[cfg(feature = "gl")]
use crate::exit::Exit;
#[cfg(feature = "gl")]
use crate::process::journal::{self, Note};
#[cfg(feature = "gl")]
use glisten_gl::{Error, Gl};

/// Reports an error if the backend is not built in.
pub(crate) fn require() -> Result<(), Failure> {
    if cfg!(feature = "gl") { Ok(()) } else { Err(not_built()) }
}

fn not_built() -> Failure {
    let failure = Failure::usage("this glisten was built without OpenGL");
    failure.help("`cargo install --path . --features gl` builds it in; `--backend cpu` draws what OpenGL should")
}

/// Draws a scene.
#[cfg(not(feature = "gl"))]
pub(crate) fn draw(_: &MachineArgs, _: &str, _: Scene) -> Result<Picture, DrawError> {
    Err(not_built().into())
}

/// Draws a scene.
#[cfg(feature = "gl")]
pub(crate) fn draw(machine: &MachineArgs, name: &str, scene: Scene) -> Result<Picture, DrawError> {
    journal::note(&Note::Driver("of OpenGL".to_owned()));
    let work = journal::drawing(name);
    // A context belongs to its thread.
    machine.within_time(move || {
        let _work = journal::at_work(&work);
        Ok(Gl::new()?.render(&scene)?)
    })
}

#[cfg(feature = "gl")]
impl From<Error> for DrawError {
    fn from(error: Error) -> Self {
        let exit = if error.is_environment() { Exit::Machine } else { Exit::Content };
        Self::Failure(crate::scenes::told(exit, &error.to_string()))
    }
}
