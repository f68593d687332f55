//! The WebAssembly module of the npm package.
//!
//! *In:* a request: the length of a JSON text as four bytes, the text, and bytes that it refers to. *Out:* a reply of the same
//! form. *Holds:* the module imports nothing: no files, no clock, no functions of the host. An include that is not in the request is
//! named in the reply, and the host asks again. After a trap the host drops the instance and makes a new one.

mod fault;
mod fixes;
mod includes;
#[cfg(feature = "play")]
mod play;
mod program;
mod reply;
mod request;
#[cfg(feature = "reference")]
mod scene;
mod texts;

use glisten_binding::Error;
use reply::Reply;
use request::Request;
use std::cell::RefCell;

thread_local! {
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static REPLY: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Makes room for a request of this length; returns where the host writes it.
#[allow(unsafe_code, reason = "the name is this module's alone")]
#[unsafe(no_mangle)]
pub extern "C" fn glisten_reserve(length: usize) -> *mut u8 {
    fault::keep();
    REQUEST.with_borrow_mut(|request| {
        *request = vec![0; length];
        request.as_mut_ptr()
    })
}

/// Answers the request; returns the length of the reply.
#[allow(unsafe_code, reason = "the name is this module's alone")]
#[unsafe(no_mangle)]
pub extern "C" fn glisten_call() -> usize {
    let request = REQUEST.take();
    let reply = answered(&request).unwrap_or_else(|error| Reply::of_error(&error));
    put(reply.into_bytes())
}

/// Where the reply is.
#[allow(unsafe_code, reason = "the name is this module's alone")]
#[unsafe(no_mangle)]
pub extern "C" fn glisten_reply() -> *const u8 {
    REPLY.with_borrow(Vec::as_ptr)
}

/// Makes the message of the panic that trapped the reply; returns its length.
#[allow(unsafe_code, reason = "the name is this module's alone")]
#[unsafe(no_mangle)]
pub extern "C" fn glisten_fault() -> usize {
    put(fault::last().into_bytes())
}

fn put(bytes: Vec<u8>) -> usize {
    let length = bytes.len();
    REPLY.set(bytes);
    length
}

fn answered(bytes: &[u8]) -> Result<Reply, Error> {
    let (request, blob) = Request::read(bytes)?;
    match request.call.as_str() {
        "compile" => program::compile(&request),
        "fix" => fixes::fix(&request),
        "upgrade" => texts::upgrade(&request),
        "format" => texts::format(&request),
        "names" => Ok(texts::names(&request)),
        "versions" => Ok(texts::versions()),
        #[cfg(feature = "reference")]
        "render" => scene::render(&request, blob),
        #[cfg(feature = "play")]
        "play" => play::play(&request, blob),
        other => {
            let _ = blob;
            Err(Error::argument(format!("this module has no call `{other}`")))
        }
    }
}
