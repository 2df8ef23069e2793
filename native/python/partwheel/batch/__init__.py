# SPDX-License-Identifier: GPL-3.0-or-later
"""Many models, each in a process of its own, into one folder of results that can be gone on with: partwheel batch."""
