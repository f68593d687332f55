//! [`Picture`]: what was drawn, as numbers in memory of the host.

use crate::pointers::{reference, take_back};
use crate::status::{Status, call};
use glisten_binding::{Drawn, Error};
use std::slice;

/// A picture: RGBA of every pixel of every color attachment, top row first, from left to right.
pub struct Picture {
    pub(crate) drawn: Drawn,
}

/// Frees a picture.
///
/// # Safety
/// `picture` is NULL, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_free(picture: *mut Picture) {
    // SAFETY: the host's.
    unsafe { take_back(picture) };
}

/// The width in pixels; 0 for NULL.
///
/// # Safety
/// `picture` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_width(picture: *const Picture) -> u32 {
    // SAFETY: the host's.
    unsafe { picture.as_ref() }.map_or(0, |picture| picture.drawn.width)
}

/// The height in pixels; 0 for NULL.
///
/// # Safety
/// `picture` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_height(picture: *const Picture) -> u32 {
    // SAFETY: the host's.
    unsafe { picture.as_ref() }.map_or(0, |picture| picture.drawn.height)
}

/// How many color attachments there are; 0 for NULL.
///
/// # Safety
/// `picture` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_attachments(picture: *const Picture) -> u32 {
    // SAFETY: the host's.
    unsafe { picture.as_ref() }.map_or(0, |picture| picture.drawn.attachments.len() as u32)
}

/// Writes values to memory of the host, if it has room for exactly as many.
///
/// # Safety
/// `place` is NULL or has room for `count` values.
unsafe fn write<T>(values: impl ExactSizeIterator<Item = T>, place: *mut T, count: usize) -> Result<Status, Error> {
    if place.is_null() || values.len() != count {
        let message = format!("there has to be room for {} values, not for {count}", values.len());
        return Err(Error::argument(message));
    }
    for (index, value) in values.enumerate() {
        // SAFETY: the caller's; the index is below the count.
        unsafe { place.add(index).write(value) };
    }
    Ok(Status::Ok)
}

/// Writes the channels of an attachment, each as `convert` makes it.
///
/// # Safety
/// `picture` is NULL or alive; `place` is NULL or has room for `count` values.
unsafe fn channels<T>(
    picture: *const Picture,
    attachment: u32,
    place: *mut T,
    count: usize,
    convert: impl Fn(f64) -> T,
) -> Status {
    call(|| {
        // SAFETY: the caller's.
        let drawn = unsafe { &reference(picture, "picture")?.drawn };
        let pixels = drawn.attachments.get(attachment as usize);
        let pixels = pixels.ok_or_else(|| Error::argument("there is no attachment with this number"))?;
        let channels: slice::Iter<'_, f64> = pixels.as_flattened().iter();
        // SAFETY: the caller's.
        unsafe { write(channels.map(|channel| convert(*channel)), place, count) }
    })
}

/// Writes an attachment as float: `count` is 4 times the width times the height.
///
/// # Safety
/// `picture` is NULL or alive; `channels` is NULL or has room for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_read_f32(
    picture: *const Picture,
    attachment: u32,
    channels: *mut f32,
    count: usize,
) -> Status {
    // SAFETY: the host's.
    unsafe { self::channels(picture, attachment, channels, count, |channel| channel as f32) }
}

/// Writes an attachment as double: `count` is 4 times the width times the height.
///
/// # Safety
/// `picture` is NULL or alive; `channels` is NULL or has room for `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_read_f64(
    picture: *const Picture,
    attachment: u32,
    channels: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: the host's.
    unsafe { self::channels(picture, attachment, channels, count, |channel| channel) }
}

/// Writes an attachment as bytes, clamped to [0, 1] and scaled to 255, without gamma: `count` is 4 times the width times the
/// height.
///
/// # Safety
/// `picture` is NULL or alive; `channels` is NULL or has room for `count` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_read_u8(
    picture: *const Picture,
    attachment: u32,
    channels: *mut u8,
    count: usize,
) -> Status {
    // SAFETY: the host's. A number that is not finite is 0 or the nearest bound, by `as`.
    unsafe {
        self::channels(picture, attachment, channels, count, |channel| (255.0 * channel.clamp(0.0, 1.0)).round() as u8)
    }
}

/// Writes for each pixel whether a fragment was drawn there (1 or 0): `count` is the width times the height.
///
/// # Safety
/// `picture` is NULL or alive; `covered` is NULL or has room for `count` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_picture_read_covered(
    picture: *const Picture,
    covered: *mut u8,
    count: usize,
) -> Status {
    call(|| {
        // SAFETY: the host's.
        let drawn = unsafe { &reference(picture, "picture")?.drawn };
        // SAFETY: the host's.
        unsafe { write(drawn.covered.iter().map(|covered| u8::from(*covered)), covered, count) }
    })
}
