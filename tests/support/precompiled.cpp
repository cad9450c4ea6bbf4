// SPDX-License-Identifier: MIT
// Nothing: the target that makes the precompiled headers of all tests needs a source.
