//! A lit sphere that turns in a window, by the module that `build.rs` made.
//!
//! *In:* optionally the number of frames after which it ends. *Out:* a window; Escape closes it. *Holds:* no number of a binding,
//! an offset or a location is in this crate.

/// The shaders, as `glisten::build` wrote them.
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

mod graphics;
#[path = "../../wgpu/src/mesh.rs"]
mod mesh;

use graphics::Graphics;
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

fn main() -> Result<(), Box<dyn Error>> {
    let frames = std::env::args().nth(1).map(|word| word.parse()).transpose()?;
    let mut app = App { frames, start: Instant::now(), shown: 0, graphics: None, failed: None };
    EventLoop::new()?.run_app(&mut app)?;
    println!("{} frames", app.shown);
    app.failed.map_or(Ok(()), Err)
}

/// The state of the program between events.
struct App {
    /// The number of frames to show; without it, until the window is closed.
    frames: Option<u64>,
    start: Instant,
    shown: u64,
    graphics: Option<Graphics>,
    failed: Option<Box<dyn Error>>,
}

impl App {
    fn open(&self, events: &ActiveEventLoop) -> Result<Graphics, Box<dyn Error>> {
        let window = events.create_window(Window::default_attributes().with_title("glisten"))?;
        pollster::block_on(Graphics::new(Arc::new(window)))
    }

    fn end(&mut self, events: &ActiveEventLoop, result: Result<(), Box<dyn Error>>) {
        self.failed = result.err();
        self.graphics = None;
        events.exit();
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match self.open(events) {
            Ok(graphics) => self.graphics = Some(graphics),
            Err(error) => self.end(events, Err(error)),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(graphics) = &mut self.graphics else { return };
        match event {
            WindowEvent::CloseRequested => self.end(events, Ok(())),
            WindowEvent::KeyboardInput { event, .. }
                if event.state == ElementState::Pressed && event.logical_key == Key::Named(NamedKey::Escape) =>
            {
                self.end(events, Ok(()));
            }
            WindowEvent::Resized(size) => graphics.resize(size),
            WindowEvent::RedrawRequested => {
                let drawn = graphics.draw(self.start.elapsed().as_secs_f32());
                self.shown += 1;
                if drawn.is_err() || self.frames.is_some_and(|frames| self.shown >= frames) {
                    self.end(events, drawn);
                } else {
                    graphics.ask_for_next();
                }
            }
            _ => {}
        }
    }
}
