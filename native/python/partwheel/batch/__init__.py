# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel batch: builds many models, each in a separate process, into one folder of results. A run can be resumed."""
