// SPDX-License-Identifier: GPL-2.0-or-later
document.querySelectorAll(".math").forEach(function (place) {
    renderMathInElement(place, { throwOnError: false });
});
