//! The program: hands the command line to the library.

// Only the allocator, which must be told what to do when there is no memory left.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;
use std::process::ExitCode;

/// The system's allocator, but for what happens when it has no memory left: the program says so and ends as after other
/// faults of the machine, rather than by a signal.
struct OrEnd;

#[global_allocator]
static MEMORY: OrEnd = OrEnd;

// SAFETY: every call is handed to the system's allocator with its own arguments.
unsafe impl GlobalAlloc for OrEnd {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        or_end(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        or_end(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        or_end(unsafe { System.realloc(block, layout, size) }, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

/// The block, or the end of the program where there is none.
#[inline]
fn or_end(block: *mut u8, bytes: usize) -> *mut u8 {
    if block.is_null() {
        end(bytes);
    }
    block
}

/// Says that there is no memory left, and ends the program with the exit code of a fault of the machine.
#[cold]
fn end(bytes: usize) -> ! {
    // The text is put together without memory.
    let mut text = [0_u8; 256];
    let mut rest = &mut text[..];
    let _ = writeln!(
        rest,
        "capsulemap: out of memory: {bytes} bytes more were refused; what is done is kept, and the same command \
         resumes: give it more memory or fewer --threads (`sweep --dry-run` estimates what it takes)"
    );
    let left = rest.len();
    let said = text.len() - left;
    let _ = std::io::stderr().write_all(&text[..said]);
    // At once: what ends in order needs memory.
    #[cfg(unix)]
    signal_hook::low_level::exit(3);
    #[cfg(not(unix))]
    std::process::exit(3);
}

fn main() -> ExitCode {
    capsulemap::cli::main(capsulemap_commit::commit!())
}
