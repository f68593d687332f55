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

/// The remedy.
const BUILT_IN: &str = "`cargo install --path . --features gl` builds it in";

/// Reports an error if the backend is not built in.
pub(crate) fn require() -> Result<(), Failure> {
    let remedy = format!("{BUILT_IN}; `--backend cpu` draws what OpenGL should");
    if cfg!(feature = "gl") { Ok(()) } else { Err(not_built().help(&remedy)) }
}

/// Reports an error if a command cannot compare with OpenGL's picture.
pub(crate) fn require_to_compare() -> Result<(), Failure> {
    if cfg!(feature = "gl") { Ok(()) } else { Err(not_built().help(BUILT_IN)) }
}

fn not_built() -> Failure {
    Failure::usage("this glisten was built without OpenGL")
}

/// Draws a scene.
#[cfg(not(feature = "gl"))]
pub(crate) fn draw(_: &MachineArgs, _: &str, _: Scene) -> Result<Picture, DrawError> {
    Err(not_built().help(BUILT_IN).into())
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
