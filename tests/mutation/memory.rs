//! How much memory a reader takes: a global allocator that counts the bytes which each thread holds.
#![allow(unsafe_code, reason = "an allocator cannot be written without; every call goes on to the system's unchanged")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    /// Bytes held now and the most since [`reset`]. Constants without destructors: reading them allocates nothing.
    static HELD: Cell<(isize, isize)> = const { Cell::new((0, 0)) };
}

/// The system's allocator, counted. Put it into a program with `#[global_allocator]`.
pub struct Counting;

fn count(change: isize) {
    // A thread that is being torn down is no longer counted.
    let _ = HELD.try_with(|held| {
        let (now, most) = held.get();
        let now = now + change;
        held.set((now, most.max(now)));
    });
}

// SAFETY: each method passes its arguments on to `System`, whose contract is the same, and returns what it returns;
// the counting beside it neither allocates nor unwinds. Sizes of layouts are at most isize::MAX.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    // Counted as the difference: the system moves the pages of large blocks instead of copying them.
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as isize - layout.size() as isize);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// The most bytes that this thread held at once during `work`, beyond those it held before, and what the work gave.
/// Zero in a program without [`Counting`].
pub fn most_during<T>(work: impl FnOnce() -> T) -> (usize, T) {
    let (before, _) = HELD.get();
    HELD.set((before, before));
    let result = work();
    let (_, most) = HELD.get();
    (usize::try_from(most - before).unwrap_or(0), result)
}
