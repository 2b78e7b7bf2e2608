//! What a C program points to: texts, numbers, structures, buffers.
//!
//! Each function says which argument is wrong. What cannot be checked (that a pointer which is not NULL leads to so
//! many values of its type) is what callers owe.

use crate::status::{Failure, Outcome, SINEW_BUFFER_TOO_SMALL};
use std::ffi::{CStr, c_char};
use std::mem::{MaybeUninit, size_of};

/// A structure of the header.
///
/// # Safety
/// It is `repr(C)`, its first field is `size: usize`, and any bytes are a value of it.
pub(crate) unsafe trait Structure: Copy {
    const NAME: &'static str;
}

fn null(what: &str) -> Failure {
    Failure::argument(format!("`{what}` is NULL"))
}

/// A text; `what` is the argument's name.
pub(crate) unsafe fn text<'a>(from: *const c_char, what: &str) -> Outcome<&'a str> {
    // SAFETY: the caller's text ends with a 0 and stays during the call
    unsafe { maybe_text(from, what) }?.ok_or_else(|| null(what))
}

/// A text that may be left out.
pub(crate) unsafe fn maybe_text<'a>(from: *const c_char, what: &str) -> Outcome<Option<&'a str>> {
    if from.is_null() {
        return Ok(None);
    }
    // SAFETY: as above
    let text = unsafe { CStr::from_ptr(from) }.to_str();
    text.map(Some).map_err(|error| Failure::argument(format!("`{what}` is no text in UTF-8: {error}")))
}

/// Values side by side; none of them may stand as NULL.
pub(crate) unsafe fn values<'a, T: Copy>(from: *const T, count: usize, what: &str) -> Outcome<&'a [T]> {
    match count {
        0 => Ok(&[]),
        _ if from.is_null() => Err(null(what)),
        // SAFETY: the caller has `count` values there, which stay during the call
        _ => Ok(unsafe { std::slice::from_raw_parts(from, count) }),
    }
}

/// Three numbers.
pub(crate) unsafe fn vector(from: *const f64, what: &str) -> Outcome<glam::DVec3> {
    // SAFETY: the caller has three numbers there
    let numbers = unsafe { values(from, 3, what) }?;
    Ok(glam::DVec3::new(numbers[0], numbers[1], numbers[2]))
}

/// Writes one value.
pub(crate) unsafe fn put<T: Copy>(to: *mut T, value: T, what: &str) -> Outcome {
    if to.is_null() {
        return Err(null(what));
    }
    // SAFETY: the caller has room for one there
    unsafe { to.write_unaligned(value) };
    Ok(())
}

/// Writes three numbers.
pub(crate) unsafe fn put_vector(to: *mut f64, value: glam::DVec3, what: &str) -> Outcome {
    // SAFETY: the caller has room for three there
    unsafe { put(to.cast::<[f64; 3]>(), value.to_array(), what) }
}

/// Fills a caller's buffer. `count` may be NULL, and the buffer where only the count is asked for.
pub(crate) unsafe fn fill<T: Copy>(values: &[T], buffer: *mut T, capacity: usize, count: *mut usize) -> Outcome {
    if !count.is_null() {
        // SAFETY: the caller has room for one there
        unsafe { count.write_unaligned(values.len()) };
    }
    if buffer.is_null() {
        return match (capacity, count.is_null()) {
            (0, false) => Ok(()),
            (0, true) => Err(Failure::argument("`buffer` and `count` are both NULL: there is nothing to do")),
            _ => Err(Failure::argument(format!("`buffer` is NULL, and `capacity` is {capacity}"))),
        };
    }
    if capacity < values.len() {
        let text = format!("`buffer` has room for {capacity} values; {} are to be written", values.len());
        return Err(Failure::new(SINEW_BUFFER_TOO_SMALL, text));
    }
    // SAFETY: the caller has room for `capacity` values there, and none of them is ours
    unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), buffer, values.len()) };
    Ok(())
}

/// Fills a caller's buffer with a text and the 0 that ends it; `count` is of bytes, that one too.
pub(crate) unsafe fn fill_text(text: &str, buffer: *mut c_char, capacity: usize, count: *mut usize) -> Outcome {
    let bytes: Vec<u8> = text.bytes().filter(|byte| *byte != 0).chain([0]).collect();
    // SAFETY: as the caller promises of its buffer; a char has the size of a byte
    unsafe { fill(&bytes, buffer.cast(), capacity, count) }
}

/// The size that the caller says a structure has: that of its header.
pub(crate) unsafe fn size_of_callers<T: Structure>(at: *const T, what: &str) -> Outcome<usize> {
    if at.is_null() {
        return Err(null(what));
    }
    // SAFETY: the first field is there whatever the caller's version of the structure is
    let size = unsafe { at.cast::<usize>().read_unaligned() };
    if size < size_of::<usize>() {
        let (name, whole) = (T::NAME, size_of::<T>());
        return Err(Failure::argument(format!("`{what}->size` is {size}: set it to sizeof({name}), here {whole}")));
    }
    Ok(size)
}

/// Reads a structure. What an older header does not have is 0; what a newer one has beyond must be 0.
pub(crate) unsafe fn read<T: Structure>(from: *const T, what: &str) -> Outcome<T> {
    // SAFETY: the caller's structure has the size that it says, and any bytes are a value
    unsafe {
        let size = size_of_callers(from, what)?;
        let beyond = values(from.cast::<u8>(), size, what)?.iter().skip(size_of::<T>());
        if beyond.into_iter().any(|byte| *byte != 0) {
            let text = format!("`{what}` asks for what this libsinew does not know: its sinew.h is of a newer version");
            return Err(Failure::argument(text));
        }
        let mut value = MaybeUninit::<T>::zeroed();
        std::ptr::copy_nonoverlapping(from.cast::<u8>(), value.as_mut_ptr().cast(), size.min(size_of::<T>()));
        Ok(value.assume_init())
    }
}

/// Writes a structure, as much of it as the caller's header has.
pub(crate) unsafe fn write<T: Structure>(to: *mut T, mut value: T, what: &str) -> Outcome {
    // SAFETY: the caller's structure has the size that it says; its first field stays
    unsafe {
        let size = size_of_callers(to, what)?;
        (&raw mut value).cast::<usize>().write_unaligned(size);
        std::ptr::copy_nonoverlapping((&raw const value).cast::<u8>(), to.cast(), size.min(size_of::<T>()));
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[derive(Clone, Copy)]
    #[repr(C)]
    struct Pair {
        size: usize,
        first: u64,
        second: u64,
    }

    // SAFETY: it is repr(C), begins with its size, and has numbers only
    unsafe impl Structure for Pair {
        const NAME: &'static str = "SinewPair";
    }

    #[test]
    fn structures_of_older_and_newer_headers_are_read_and_written() {
        let word = size_of::<usize>();
        let older = [2 * word, 7, 9];
        // SAFETY: two words are there, as the first says
        let read_pair = unsafe { read(older.as_ptr().cast::<Pair>(), "pair") }.unwrap();
        assert_eq!((read_pair.first, read_pair.second), (7, 0));
        let mut newer = [4 * word, 7, 9, 0];
        // SAFETY: four words are there
        let read_pair = unsafe { read(newer.as_ptr().cast::<Pair>(), "pair") }.unwrap();
        assert_eq!((read_pair.first, read_pair.second), (7, 9));
        newer[3] = 1;
        // SAFETY: four words are there
        assert!(unsafe { read(newer.as_ptr().cast::<Pair>(), "pair") }.is_err());
        let mut kept = [2 * word, 0, 5];
        // SAFETY: two words may be written
        unsafe { write(kept.as_mut_ptr().cast::<Pair>(), Pair { size: 0, first: 3, second: 4 }, "pair") }.unwrap();
        assert_eq!(kept, [2 * word, 3, 5]);
    }

    #[test]
    fn a_buffer_is_filled_or_left_alone() {
        let (mut room, mut count) = ([0_u32; 2], 0);
        // SAFETY: room for as many as is said
        unsafe {
            assert!(fill(&[1, 2, 3], room.as_mut_ptr(), 2, &raw mut count).is_err());
            assert_eq!((room, count), ([0, 0], 3));
            fill(&[1, 2], room.as_mut_ptr(), 2, std::ptr::null_mut()).unwrap();
            assert_eq!(room, [1, 2]);
            assert!(fill(&[1], std::ptr::null_mut(), 0, std::ptr::null_mut()).is_err());
            assert!(fill(&[1], std::ptr::null_mut(), 1, &raw mut count).is_err());
        }
    }
}
